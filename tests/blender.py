"""Run by Blender: draws with Grease Pencil, paints with the add-on and looks at what comes back.
With a display it also compares the drawing that the add-on writes with Blender's own picture.

usage: blender -b --factory-startup --python blender.py -- ADD-ON FOLDER
"""
import importlib.util
import math
import os
import subprocess
import sys

import bpy
import numpy as np

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


def material(pencil, **own):
    one = bpy.data.materials.new('one')
    bpy.data.materials.create_gpencil_data(one)
    style = one.grease_pencil
    style.show_stroke, style.show_fill = 'color' in own, 'fill_color' in own
    for key, value in own.items():
        setattr(style, key, value)
    pencil.materials.append(one)
    return len(pencil.materials) - 1


def shape(frame, index, points, width=10, closed=True, pressure=lambda i: 1):
    stroke = frame.strokes.new()
    stroke.material_index, stroke.use_cyclic, stroke.line_width, stroke.display_mode = index, closed, width, '3DSPACE'
    stroke.points.add(len(points))
    for i, (point, (x, z)) in enumerate(zip(stroke.points, points)):
        point.co, point.pressure, point.strength = (x, 0, z), pressure(i), 1
    stroke.points.update()
    return stroke


def disc(x, y, r):
    return [(x + r * math.cos(math.pi * i / 24), y + r * math.sin(math.pi * i / 24)) for i in range(48)]


def box(x, y, w, h):
    return [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]


def draw_layers():
    """Two layers and a mask, with vertex colours, a hole, a tint, gradients and a line that swells."""
    draw()
    pencil = bpy.data.objects['figure'].data
    pencil.layers.remove(pencil.layers[0])
    pencil.materials.clear()
    red = material(pencil, fill_color=(0.4, 0.03, 0.01, 1))
    linear = material(pencil, fill_color=(0.9, 0.5, 0.05, 1), mix_color=(0.1, 0.02, 0.4, 1), mix_factor=0,
                      fill_style='GRADIENT')
    radial = material(pencil, fill_color=(0.8, 0.8, 0.1, 1), mix_color=(0.3, 0, 0.2, 1), mix_factor=0, flip=True,
                      fill_style='GRADIENT', gradient_type='RADIAL', texture_angle=0.4, texture_scale=(3, 2))
    hole = material(pencil, fill_color=(0, 0, 0, 1), use_fill_holdout=True)
    line = material(pencil, color=(0.02, 0.02, 0.05, 1))
    mask, back, front = (pencil.layers.new(name) for name in ('Mask', 'Back', 'Front'))
    for layer in (mask, back, front):
        layer.use_lights = False
    shape(mask.frames.new(1), red, disc(0.4, -0.3, 1.5))
    frame = back.frames.new(1)
    shape(frame, red, box(-2.2, -1, 1.6, 2)).vertex_color_fill = (0.02, 0.4, 0.05, 1)
    shape(frame, linear, box(-0.4, -1, 1, 2))
    shape(frame, radial, disc(1.6, 0, 0.7))
    shape(frame, hole, disc(-1.4, 0, 0.4))
    back.tint_color, back.tint_factor = (0.6, 0.6, 0), 0.25
    frame = front.frames.new(1)
    swelling = shape(frame, line, [(-2 + 0.08 * i, -0.6 + 0.4 * math.sin(0.3 * i)) for i in range(50)], 200, False,
                     lambda i: 0.2 + 0.8 * abs(math.sin(0.1 * i)))
    for point in swelling.points:
        point.vertex_color = (0.8, 0, 0, 0.5)
    front.use_mask_layer = True
    front.mask_layers.add(mask)
    hidden = pencil.layers.new('Hidden')
    hidden.hide = True
    front.mask_layers.add(hidden)
    back.location, back.rotation = (0.1, 0, 0.1), (0, 0.1, 0)
    scene = bpy.context.scene
    scene.frame_end = 1
    scene.render.resolution_x, scene.render.resolution_y = 480, 270
    scene.render.engine, scene.render.film_transparent = 'BLENDER_WORKBENCH', True
    scene.view_settings.view_transform = 'Standard'


def pixels(path):
    picture = bpy.data.images.load(path)
    return np.array(picture.pixels[:]).reshape(*reversed(picture.size), 4)


def lab(rgb):
    light = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = light @ np.array([[0.4124, 0.2126, 0.0193], [0.3576, 0.7152, 0.1192], [0.1805, 0.0722, 0.9505]])
    f = np.cbrt(xyz / (0.9505, 1, 1.089))
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


def compare_with_blender():
    draw_layers()
    context, scene = bpy.context, bpy.context.scene
    frames, lost = addon.export_frames(context, os.path.join(folder, 'layers'))
    assert not lost, lost
    scene.render.filepath = os.path.join(folder, 'blender.png')
    bpy.ops.render.render(write_still=True)
    ours = os.path.join(folder, 'ours.png')
    subprocess.run(['rsvg-convert', frames % 1, '-o', ours], check=True)
    a, b = pixels(scene.render.filepath), pixels(ours)
    edge = np.zeros(a.shape[:2], bool)  # within two pixels of an edge of either
    for picture in (a, b):
        for axis in (0, 1):
            steps = np.abs(np.diff(picture, axis=axis)).max(-1) > 0.05
            for shift in (-2, -1, 0, 1, 2, 3):
                rolled = np.roll(np.pad(steps, [(0, axis == 0), (0, axis == 1)]), shift, axis)
                edge |= rolled
    coverage = -10 * math.log10(((a[..., 3] - b[..., 3])[~edge] ** 2).mean() + 1e-9)
    inside = ~edge & (a[..., 3] > 0.99)
    apart = np.linalg.norm(lab(a[..., :3]) - lab(b[..., :3]), axis=-1)[inside]
    assert inside.mean() > 0.3 and coverage > 40 and apart.max() < 3, (inside.mean(), coverage, apart.max())
    print(f'coverage {coverage:.0f} dB, colours at most {apart.max():.1f} apart')


addon.register()
if os.environ.get('DISPLAY'):
    compare_with_blender()
draw()
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
    bpy.data.objects['figure'].hide_render = False
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
