#!/bin/sh
# ./run test with stubs in place of what it calls: run_test.sh SOURCE
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
cp "$1/run" "$1/.packages" "$work"

stub() { # NAME LINES: a command that writes its own name and words into `calls`, then does LINES
    printf '#!/bin/sh\necho "%s $*" >>"%s/calls"\n%s\n' "$1" "$work" "$2" >"$work/bin/$1"
    chmod +x "$work/bin/$1"
}

run() { # WORDS of ./run: its exit code in `code`, what it called in `calls`, what it printed in `output`
    : >"$work/calls"
    code=0
    PATH="$work/bin:$PATH" "$work/run" "$@" >"$work/output" 2>&1 || code=$?
}

expect() { # WHAT CONDITION...
    what=$1
    shift
    "$@" && return
    echo "not true: $what"
    cat "$work/calls" "$work/output"
    exit 1
}
called() { grep -qx "$1" "$work/calls"; }
printed() { grep -q "$1" "$work/output"; }

stub npm ''
stub sudo '"$@"'
stub apt-get ''
stub dpkg-query "sed 's/.*/installed, &, /' '$work/.packages'"
stub cmake ''
stub ctest ''

run test
expect "a run without a failure succeeds" [ "$code" = 0 ]
expect "both presets are tested" called "ctest --preset release"
expect "both presets are tested" called "ctest --preset dev"
expect "nothing is installed where all is there" [ -z "$(grep apt-get "$work/calls")" ]

stub ctest 'echo "closing lines of $2"; [ "$2" != release ]'
run test
expect "a failing suite makes the run fail" [ "$code" = 1 ]
expect "a failing release suite does not keep dev from running" called "ctest --preset dev"
expect "the closing lines of both suites are printed" printed "closing lines of release"
expect "the closing lines of both suites are printed" printed "closing lines of dev"
expect "what failed is said at the end" printed "failed in release"
run test dev
expect "one preset alone is judged alone" [ "$code" = 0 ]

stub ctest ''
stub cmake 'echo "words of $*"; [ "$*" != "--preset release" ]'
run test
expect "a build that fails makes the run fail" [ "$code" = 1 ]
expect "a suite that was not built does not run" [ -z "$(grep "ctest --preset release" "$work/calls")" ]
expect "it does not keep dev from running" called "ctest --preset dev"
expect "why it was not built is printed" printed "words of --preset release"

stub cmake ''
stub dpkg-query ''
stub apt-get '! echo "$*" | grep -q chromium-common'
run test
expect "tests run without what only some of them need" [ "$code" = 0 ]
expect "they say so" printed "tests that need these are skipped"
run bench dice
expect "only tests ask for what only tests need" [ -z "$(grep chromium "$work/calls")" ]
