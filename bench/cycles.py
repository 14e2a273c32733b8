"""Renders a displaced cage by Blender's Cycles, with micropolygons one pixel large and one sample per pixel, for comparison with
`relief render --edge-pixels 1`:

    blender -b -noaudio -t 2 -P bench/cycles.py -- CAGE.obj MAP.exr|none SCALE MID WIDTH,HEIGHT PICTURE.png

The camera is relief's default one: 30 degrees to the right, 20 up, a vertical field of view of 30, and the object fills the picture.
Written for Blender 3.4."""
import math
import sys

import bpy
from mathutils import Vector

AZIMUTH, ELEVATION, FIELD_OF_VIEW = (math.radians(angle) for angle in (30, 20, 30))


def subdivided(cage):
    bpy.ops.import_scene.obj(filepath=cage, axis_forward="-Z", axis_up="Y", use_split_objects=False, use_split_groups=False)
    thing = next(each for each in bpy.context.scene.objects if each.type == "MESH")
    bpy.context.view_layer.objects.active = thing
    thing.modifiers.new("subdivision", "SUBSURF").subdivision_type = "CATMULL_CLARK"
    thing.cycles.use_adaptive_subdivision = True
    thing.cycles.dicing_rate = 1
    return thing


def displaced_material(height, scale, mid):
    material = bpy.data.materials.new("displaced")
    material.use_nodes = True
    material.cycles.displacement_method = "DISPLACEMENT"
    if height == "none":
        return material
    nodes, links = material.node_tree.nodes, material.node_tree.links
    image, displacement = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeDisplacement")
    image.image = bpy.data.images.load(height)
    image.image.colorspace_settings.name = "Non-Color"
    displacement.inputs["Midlevel"].default_value = mid
    displacement.inputs["Scale"].default_value = scale
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    links.new(image.outputs["Color"], displacement.inputs["Height"])
    links.new(displacement.outputs["Displacement"], output.inputs["Displacement"])
    return material


def add_camera(scene, points, aspect):
    back = Vector((math.sin(AZIMUTH) * math.cos(ELEVATION), -math.cos(AZIMUTH) * math.cos(ELEVATION), math.sin(ELEVATION)))
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "VERTICAL", FIELD_OF_VIEW
    camera = bpy.data.objects.new("camera", data)
    camera.rotation_euler = (-back).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    bpy.context.view_layer.update()
    right, up = camera.matrix_world.to_3x3().col[0], camera.matrix_world.to_3x3().col[1]
    tangent = 0.95 * math.tan(FIELD_OF_VIEW / 2)
    target = sum(points, Vector()) / len(points)
    for _ in range(4):  # the distance that holds all points, then their middle as it is seen from there
        distance = max(max(abs((p - target).dot(right)) / (tangent * aspect), abs((p - target).dot(up)) / tangent) +
                       (p - target).dot(back) for p in points)
        seen = [((p - target).dot(right), (p - target).dot(up), distance - (p - target).dot(back)) for p in points]
        for axis, direction in enumerate((right, up)):
            sides = [each[axis] / each[2] for each in seen]
            target += direction * distance * (min(sides) + max(sides)) / 2
    camera.location = target + distance * back
    data.clip_start, data.clip_end = distance / 100, 10 * distance
    scene.camera = camera


def main(cage, height, scale, mid, size, picture):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    thing = subdivided(cage)
    thing.data.materials.clear()
    thing.data.materials.append(displaced_material(height, float(scale), float(mid)))
    width, rows = (int(word) for word in size.split(","))
    add_camera(scene, [thing.matrix_world @ vertex.co for vertex in thing.data.vertices], width / rows)

    # Light: a sun and a grey sky.
    scene.world = bpy.data.worlds.new("sky")
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.9, 0.2, 0.6)
    scene.collection.objects.link(sun)

    render, cycles = scene.render, scene.cycles
    render.engine, cycles.feature_set, cycles.device = "CYCLES", "EXPERIMENTAL", "CPU"
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 1, False, False
    cycles.dicing_rate, cycles.max_subdivisions = 1, 12
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, rows, 100
    render.filepath, render.image_settings.file_format = picture, "PNG"
    bpy.ops.render.render(write_still=True)


main(*sys.argv[sys.argv.index("--") + 1:])
