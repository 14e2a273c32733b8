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
    "$relief" render "$meshes/$cage.obj" --map-format unorm16 "$@" -q --json -o "$out/$name.png" >"$out/stats.json"
    printf '%-22s %8s %8s %9s %7s %10s %7.0f\n' "$out/$name.png" "$(kib "$(field cage_bytes)")" "$(kib "$(field map_bytes)")" \
        "$(kib "$(field dense_bytes)")" "$(awk "BEGIN { printf \"%.1f\", $(field dense_bytes) / ($(field cage_bytes) + $(field map_bytes)) }")" \
        "$(field triangles)" "$(field frame_ms)"
}

maps=$out/maps
printf '%-22s %8s %8s %9s %7s %10s %7s\n' picture 'cage KiB' 'map KiB' 'dense KiB' 'ratio' triangles ms
picture octopus octopus --height "$maps/octopus.exr" --albedo "$maps/octopus_albedo.png" \
    --azimuth -10 --elevation 12 --fov 24 --edge-pixels 1.2 --size 1600,1000
picture suckers octopus --height "$maps/octopus.exr" --albedo "$maps/octopus_albedo.png" \
    --azimuth -60 --elevation 6 --look-at -2.2,1.0,0.95 --distance 4.2 --edge-pixels 1.2 --size 960,800
picture orange ball --height "$maps/orange.exr" --albedo "$maps/orange_albedo.png" --elevation 35 --edge-pixels 1.5 \
    --roughness 0.35 --size 800,800
picture golf torus --height "$maps/golf.exr" --path grid --azimuth 25 --elevation 38 --color 0.6,0.6,0.58 \
    --edge-pixels 1.5 --size 960,800
picture moon ball --height "$maps/moon.exr" --albedo "$maps/moon_albedo.png" --path grid --elevation 12 --light 320,18 \
    --roughness 0.95 --edge-pixels 1.2 --background 0.02,0.02,0.03 --size 800,800
picture strawberry strawberry --height "$maps/strawberry.exr" --albedo "$maps/strawberry_albedo.png" --azimuth 20 \
    --elevation 14 --edge-pixels 1.5 --roughness 0.3 --size 800,960
picture terrain plane --height "$maps/terrain.exr" --albedo "$maps/terrain_albedo.png" --wrap clamp --path grid \
    --azimuth 20 --elevation 30 --roughness 0.9 --edge-pixels 1.5 --size 1280,800
picture lantern lantern --height "$maps/lantern.exr" --albedo "$maps/lantern_albedo.png" --azimuth 20 --elevation 18 \
    --roughness 0.3 --edge-pixels 1.5 --size 800,960
picture bricks cube --height "$maps/bricks.exr" --albedo "$maps/bricks_albedo.png" --elevation 22 --roughness 0.8 \
    --edge-pixels 1.5 --path grid --size 800,800
picture wireframe octopus --height "$maps/octopus.exr" --show wireframe --azimuth -10 --elevation 12 --fov 24 \
    --edge-pixels 10 --size 1280,800
# Light: metal, three lights with creases, and a ball's picture in place of both.
picture metal torus --height "$maps/golf.exr" --metallic 1 --roughness 0.15 --color 0.95,0.64,0.37 --occlusion 0.1 \
    --azimuth 25 --elevation 32 --edge-pixels 1.5 --size 960,540
picture lights octopus --height "$maps/octopus.exr" --color 0.6,0.6,0.6 --azimuth -10 --elevation 12 --fov 24 --occlusion 0.1 \
    --light -50,40,2,1,0.95,0.9 --light 70,15,2.5,1,0.35,0.15 --light 200,30,2,0.2,0.4,1 --edge-pixels 1.5 --size 960,600
"$relief" matcap --color 0.75,0.2,0.1 --roughness 0.25 --metallic 0 -q -o "$out/matcap_ball.png"
picture matcap octopus --height "$maps/octopus.exr" --shading matcap --matcap "$out/matcap_ball.png" --azimuth -10 \
    --elevation 12 --fov 24 --edge-pixels 1.5 --size 960,600
# An environment with labels in its three shapes, and a mirror that shows it.
for shape in equirect sphere; do
    "$relief" environment "$maps/labels_albedo.png" -o "$out/labels_$shape.png" --shape $shape --side 256 -q
done
"$relief" environment "$maps/labels_albedo.png" -o "$out/labels_cube.png" --shape cube --side 85 -q
"$relief" render "$meshes/torus.obj" --environment "$maps/labels_albedo.png" --metallic 1 --roughness 0 --color 0.95,0.95,0.95 \
    --no-shadows --light 0,90,0 --edge-pixels 3 --size 400,256 -q -o "$out/labels_mirror.png"
# A globe: its relief moves the surface, and what is finer bends normals.
"$relief" normal-map "$maps/globe_detail.exr" --scale 2 --size 6.28,4.19 -q -o "$out/globe_normals.png"
picture globe ball --height "$maps/globe.exr" --scale 0.7 --albedo "$maps/globe_albedo.png" --normal-map "$out/globe_normals.png" \
    --azimuth -25 --elevation 12 --light -60,30 --roughness 0.55 --background 0.01,0.01,0.02 --edge-pixels 1.5 --size 800,800
# A fractal terrain on a grid of 100 x 100, which cuts its ridges, and on triangles of two pixels.
for how in grid adaptive; do
    set -- --edge-pixels 2
    [ $how = adaptive ] || set -- --rate 12 # of 8 x 8 faces
    picture terrain_$how plane --height "$maps/terrain.exr" --albedo "$maps/terrain_albedo.png" --wrap clamp --path grid \
        --azimuth 20 --elevation 14 --look-at 0,0.05,0.5 --distance 1.6 --roughness 0.9 --size 640,400 "$@"
done
rm -f "$out/stats.json"

# What heights can do besides: techniques side by side.
compare() { # NAME CAGE HOW,HOW OPTIONS...
    name=$1
    cage=$2
    how=$3
    shift 3
    "$relief" render "$meshes/$cage.obj" --compare "$how" "$@" -q -o "$out/$name.png"
    echo "$out/$name.png"
}
compare compared torus bump,displacement,both,none --height "$maps/golf.exr" --rate 12 --elevation 30 --size 480,360
compare silhouette ball bump,displacement --height "$maps/orange.exr" --scale 4 --rate 128 --path grid --size 480,480
compare formula torus bump,displacement --height-function golf --scale 0.5 --rate 96 --path dice --elevation 30 --size 480,360
# A moon by its colors, by a normal map made of its heights, and by both, lit from the left and from the right.
"$relief" normal-map "$maps/moon.exr" --scale 0.8 --size 6.28,4.19 -q -o "$out/moon_normals.png"
for side in left right; do
    light=-45,15
    [ $side = left ] || light=105,15
    for what in colors normals both; do
        set -- --rate 24 --elevation 12 --light $light --roughness 0.95 --no-shadows --background 0.02,0.02,0.03 --size 320,320
        [ $what = normals ] || set -- "$@" --albedo "$maps/moon_albedo.png"
        [ $what = colors ] || set -- "$@" --normal-map "$out/moon_normals.png"
        "$relief" render "$meshes/ball.obj" "$@" -q -o "$out/moon_${side}_$what.png"
    done
done
# Bumps towards the limb, by each filter.
for filter in nearest bilinear mipmap anisotropic; do
    "$relief" render "$meshes/ball.obj" --height "$maps/orange.exr" --scale 1.5 --detail bump --filter $filter --rate 24 \
        --elevation 25 --fov 24 --roughness 0.35 --light 300,25 --no-shadows --size 300,300 -q -o "$out/filter_$filter.png"
done

# A sculpt, the limit surface of its cage, the same surface displaced by what was baked, and how far it is off.
"$relief" export "$meshes/strawberry.obj" --height "$maps/strawberry.exr" --rate 24 -q -o "$out/sculpt.obj"
"$relief" bake "$meshes/strawberry.obj" "$out/sculpt.obj" --size 1024,1024 -q -o "$out/baked.exr" --heatmap "$out/bake_error.png"
set -- --color 0.75,0.75,0.72 --size 400,400 -q
"$relief" render "$out/sculpt.obj" "$@" -o "$out/bake_sculpt.png"
"$relief" render "$meshes/strawberry.obj" "$@" -o "$out/bake_limit.png"
"$relief" render "$meshes/strawberry.obj" --height "$out/baked.exr" --edge-pixels 1 "$@" -o "$out/bake_displaced.png"
rm -f "$out/sculpt.obj" "$out/baked.exr"

# The same strawberry cut open and spread over a square: the normals there, and what three mips show.
"$relief" geometry-image "$meshes/strawberry.obj" --height "$maps/strawberry.exr" --size 257 -q -o "$out/spread.exr" \
    --picture "$out/geometry_image.png"
for mip in 2 1 0; do
    "$relief" render "$out/spread.exr" --mip $mip "$@" -o "$out/geometry_image_$mip.png"
done
rm -f "$out/spread.exr"

# Per frame only the cage's 1958 points go to the device.
"$relief" animate "$meshes/octopus.obj" --map-format unorm16 --height "$maps/octopus.exr" --albedo "$maps/octopus_albedo.png" \
    --deform "twist(axis=y, angle=35*sin(pi*t)) wave(axis=x, amplitude=0.035, wavelength=0.5, speed=0.25, along=y) \
        squash(axis=y, amount=0.08*sin(2*pi*t))" \
    --frames 0:47 --azimuth -10 --elevation 14 --fov 24 --edge-pixels 2 --spacing fractional --size 560,350 \
    -o "$out/octopus.webp"
# Waves by a formula that moves with the time: they mirror the sky, and bend what is seen of a tiled floor.
"$relief" animate "$meshes/plane.obj" --height-function waves --scale 0.25 --path dice --edge-pixels 3 --shading water \
    --water-floor 0.3,0.8,0.72,0.55,0.125 --color 0.35,0.75,0.78 --roughness 0.02 --light 200,35 --azimuth 20 --elevation 26 \
    --look-at 0,0,0.25 --distance 2.2 --frames 0:47 --size 400,250 -q -o "$out/waves.webp"
