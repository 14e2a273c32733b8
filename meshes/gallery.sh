#!/bin/sh
# The gallery: gallery.sh RELIEF OUT renders every picture into OUT (maps lie in OUT/maps) and prints what each took.
set -eu
relief=$1
out=$2
meshes=$(dirname "$0")

field() { sed -n "s/.*\"$1\": \([0-9.]*\).*/\1/p" "$out/stats.json"; }
kib() { awk "BEGIN { printf \"%.0f\", $1 / 1024 }"; }

picture() { # NAME CAGE OPTIONS...
    name=$1
    cage=$2
    shift 2
    "$relief" render "$meshes/$cage.obj" "$@" -q --json -o "$out/$name.png" >"$out/stats.json"
    printf '%-22s %8s %8s %9s %7s %10s %7.0f\n' "$out/$name.png" "$(kib "$(field cage_bytes)")" "$(kib "$(field map_bytes)")" \
        "$(kib "$(field dense_bytes)")" "$(awk "BEGIN { printf \"%.1f\", $(field dense_bytes) / ($(field cage_bytes) + $(field map_bytes)) }")" \
        "$(field triangles)" "$(field frame_ms)"
}

maps=$out/maps
printf '%-22s %8s %8s %9s %7s %10s %7s\n' picture 'cage KiB' 'map KiB' 'dense KiB' 'ratio' triangles ms
picture octopus octopus --height "$maps/octopus.exr" --albedo "$maps/octopus_albedo.png" --edge-pixels 1.2 --size 1280,1024
picture orange ball --height "$maps/orange.exr" --albedo "$maps/orange_albedo.png" --edge-pixels 1.5 --roughness 0.35
picture golf torus --height "$maps/golf.exr" --path grid --edge-pixels 1.5 --elevation 35 --color 0.75,0.75,0.72 --size 1024,768
picture moon ball --height "$maps/moon.exr" --albedo "$maps/moon_albedo.png" --edge-pixels 1.5 --roughness 0.9 --light -60,15 --background 0.02,0.02,0.03
picture strawberry strawberry --height "$maps/strawberry.exr" --albedo "$maps/strawberry_albedo.png" --edge-pixels 1.5 --roughness 0.3
picture terrain plane --height "$maps/terrain.exr" --albedo "$maps/terrain_albedo.png" --wrap clamp --path grid --edge-pixels 1.5 --elevation 30 --roughness 0.9 --size 1280,800
picture wireframe octopus --height "$maps/octopus.exr" --show wireframe --edge-pixels 10 --size 1280,1024
rm -f "$out/stats.json"
