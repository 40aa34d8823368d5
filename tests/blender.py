"""Run by Blender: draws with Grease Pencil, paints with the add-on and looks at what comes back.

usage: blender -b --factory-startup --python blender.py -- ADD-ON FOLDER
"""
import importlib.util
import math
import os
import sys

import bpy

addon_file, folder = sys.argv[sys.argv.index('--') + 1:]
spec = importlib.util.spec_from_file_location('fluidy_svg', addon_file)
addon = importlib.util.module_from_spec(spec)
sys.modules['fluidy_svg'] = addon
spec.loader.exec_module(addon)


def draw():
    """A disc that goes right and up, and a camera before it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    pencil = bpy.data.grease_pencils.new('figure')
    thing = bpy.data.objects.new('figure', pencil)
    bpy.context.collection.objects.link(thing)
    material = bpy.data.materials.new('red')
    bpy.data.materials.create_gpencil_data(material)
    material.grease_pencil.show_fill = True
    material.grease_pencil.fill_color = (0.4, 0.03, 0.01, 1)
    pencil.materials.append(material)
    layer = pencil.layers.new('Fills')
    for number in (1, 2, 3):
        stroke = layer.frames.new(number).strokes.new()
        stroke.use_cyclic, stroke.line_width = True, 40
        stroke.points.add(24)
        for i, point in enumerate(stroke.points):
            turn = i * math.pi / 12
            point.co = (math.cos(turn) + number - 2, 0, math.sin(turn) + 0.2 * number)
            point.pressure = point.strength = 1
    camera = bpy.data.objects.new('camera', bpy.data.cameras.new('camera'))
    camera.location, camera.rotation_euler = (0, -8, 0), (math.pi / 2, 0, 0)
    bpy.context.collection.objects.link(camera)
    scene = bpy.context.scene
    scene.camera, scene.frame_start, scene.frame_end = camera, 1, 3
    scene.render.resolution_x, scene.render.resolution_y = 160, 90


draw()
addon.register()
scene = bpy.context.scene
scene.fluidy.folder = folder
scene.fluidy.style = 'ink'
assert bpy.ops.fluidy.paint() == {'FINISHED'}
heads = {open(os.path.join(folder, 'drawing', f'frame_000{n}.svg')).readline() for n in (1, 2, 3)}
assert len(heads) == 1 and 'viewBox="0 0 160 90"' in heads.pop(), 'pages differ'
plane = bpy.data.objects['Fluidy']
image = plane.data.materials[0].node_tree.nodes['Image Texture'].image
assert image.source == 'SEQUENCE' and image.filepath.endswith('painted_0001.png')
if hasattr(scene, 'cycles'):  # the plane lies where the drawing is, in every frame
    bpy.data.objects['figure'].hide_render = True
    scene.render.engine, scene.cycles.samples, scene.render.film_transparent = 'CYCLES', 1, True
    scene.cycles.use_denoising = False
    for number in (1, 3):
        scene.frame_set(number)
        scene.render.filepath = os.path.join(folder, f'render_{number}.png')
        bpy.ops.render.render(write_still=True)
        picture = bpy.data.images.load(scene.render.filepath)
        alpha = [sum(picture.pixels[4 * (160 * (90 - y) + x) + 3] for x in range(c - 4, c + 5)
                     for y in range(36 - 3 * number, 42 - 3 * number)) / 54 for c in (52, 108)]
        assert (alpha[0] > 0.4) == (number == 1) and (alpha[1] > 0.4) == (number == 3), (number, alpha)
scene.fluidy.result = 'COMPOSITOR'
assert bpy.ops.fluidy.paint() == {'FINISHED'}
node = next(n for n in scene.node_tree.nodes if n.label == 'Fluidy')
assert node.frame_duration == 3 and node.frame_start == 1
for program, style, told in (('no-such-program', '', 'Install fluidy-svg'), ('fluidy-svg', 'none', 'no style')):
    scene.fluidy.program, scene.fluidy.other_style = program, style
    try:
        bpy.ops.fluidy.paint()
        sys.exit('no error')
    except RuntimeError as problem:
        assert told in str(problem), problem
addon.unregister()
print('the add-on works')
