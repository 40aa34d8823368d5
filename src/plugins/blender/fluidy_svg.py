"""Paints Grease Pencil with fluidy-svg.

The frames of the scene are written as SVG files that all have the page of the render: Blender's own
export gives each frame a page of its own, so that a drawing slides. The program paints them, and the
painted frames come back as an image plane before the camera or into the compositor.
"""
import json
import math
import os
import re
import shlex
import subprocess
import threading
from collections import namedtuple
from xml.sax.saxutils import quoteattr

import bpy
from bpy.props import EnumProperty, StringProperty
from bpy_extras.object_utils import world_to_camera_view

bl_info = {
    'name': 'Fluidy: painted Grease Pencil',
    'author': 'fluidy-svg',
    'version': (0, 1, 0),
    'blender': (3, 0, 0),
    'location': '3D View > Sidebar > Fluidy',
    'description': 'Paints the Grease Pencil frames of the scene with moving watercolour',
    'category': 'Render',
}

STYLES = ['watercolour', 'ink', 'bloom', 'charcoal', 'wash', 'two-pigments', 'gouache', 'dry-brush',
          'backruns', 'pastel', 'pools', 'smoke', 'fire', 'billows', 'water']
LINE_M = 0.001  # world size of a line's thickness of one


# ---- what Grease Pencil holds, of either age -------------------------------------------------------
# Blender up to 4.2 keeps strokes as GPENCIL, later ones as GREASEPENCIL with radii in metres.

Point = namedtuple('Point', 'co radius opacity mix')  # radius in metres, or px if negative; mix: RGBA, A its share
Stroke = namedtuple('Stroke', 'points closed material mix fill_opacity uv flat')
Layer = namedtuple('Layer', 'name matrix opacity tint blend masks lights strokes')  # matrix: or None; masks: (name, inverted)


def material_of(thing, index):
    slot = thing.material_slots[index].material if 0 <= index < len(thing.material_slots) else None
    return slot.grease_pencil if slot and slot.grease_pencil and not slot.grease_pencil.hide else None


def masks_of(layer, used):
    return [(mask.name, mask.invert) for mask in layer.mask_layers if not mask.hide] if used else []


def old_layers(thing):
    pencil = thing.data
    for layer in pencil.layers:
        metres = LINE_M * pencil.pixel_factor if pencil.stroke_thickness_space == 'WORLDSPACE' else -1
        strokes = []
        for stroke in layer.active_frame.strokes if layer.active_frame else []:
            width = max(stroke.line_width + layer.line_change, 1) * metres / 2
            points = [Point(p.co, width * p.pressure, p.strength, p.vertex_color) for p in stroke.points]
            strokes.append(Stroke(points, stroke.use_cyclic, material_of(thing, stroke.material_index),
                                  stroke.vertex_color_fill, 1, [tuple(p.uv_fill) for p in stroke.points],
                                  stroke.start_cap_mode == 'FLAT'))
        # the points of an evaluated object have the transform of their layer and of its parent
        yield layer.hide, Layer(layer.info, None, layer.opacity,
                                (*layer.tint_color, layer.tint_factor), layer.blend_mode,
                                masks_of(layer, layer.use_mask_layer), layer.use_lights, strokes)


def new_layers(thing):
    for layer in thing.data.layers:
        frame = layer.current_frame()
        matrix = layer.matrix_local
        if layer.parent:
            bone = layer.parent.pose and layer.parent.pose.bones.get(layer.parent_bone)
            parent = layer.parent.matrix_world @ bone.matrix if bone else layer.parent.matrix_world
            matrix = thing.matrix_world.inverted() @ parent @ layer.matrix_parent_inverse @ matrix
        strokes = []
        for stroke in frame.drawing.strokes if frame else []:
            points = [Point(p.position, max(p.radius + layer.radius_offset, 0), p.opacity, p.vertex_color)
                      for p in stroke.points]
            strokes.append(Stroke(points, stroke.cyclic, material_of(thing, stroke.material_index),
                                  stroke.fill_color, stroke.fill_opacity, None, stroke.start_cap == 1))
        yield layer.hide, Layer(layer.name, matrix, layer.opacity, (*layer.tint_color, layer.tint_factor),
                                layer.blend_mode, masks_of(layer, layer.use_masks), layer.use_lights, strokes)


LAYERS = {'GPENCIL': old_layers, 'GREASEPENCIL': new_layers}


# ---- colours, in linear light as Blender has them ---------------------------------------------------

def mixed(colour, other, share):
    return [a + (b - a) * share for a, b in zip(colour[:3], other[:3])]


def srgb(linear):
    """A linear colour as #rrggbb."""
    levels = []
    for value in linear[:3]:
        value = min(max(value, 0), 1)
        light = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
        levels.append(round(255 * light))
    return '#%02x%02x%02x' % tuple(levels)


def mean(values):
    values = [tuple(value) for value in values]
    return [sum(each) / len(values) for each in zip(*values)]


# ---- Grease Pencil to SVG ------------------------------------------------------------------------

class Page:
    """The picture that the camera takes, in pixels, and what of the drawing SVG cannot say."""

    def __init__(self, scene):
        render = scene.render
        self.scene, self.camera = scene, scene.camera
        self.width = render.resolution_x * render.resolution_percentage // 100
        self.height = render.resolution_y * render.resolution_percentage // 100
        self.defs, self.names, self.lost = [], {}, set()

    def place(self, point):
        """x, y and depth of a point of the world; None behind the camera."""
        at = world_to_camera_view(self.scene, self.camera, point)
        return (at.x * self.width, (1 - at.y) * self.height, at.z) if at.z > 0 else None

    def px_per_m(self, depth):
        corners = self.camera.data.view_frame(scene=self.scene)
        frame_m = abs(corners[2].x - corners[0].x)
        if self.camera.data.type == 'ORTHO':
            return self.width / frame_m
        return self.width / frame_m * -corners[0].z / depth

    def id(self, *words):
        """An id that a stroke has in every frame in which it is drawn in the same place of its layer."""
        name = '-'.join(re.sub(r'[^\w.]+', '_', str(word)) for word in words)
        self.names[name] = self.names.get(name, 0) + 1
        return name if self.names[name] == 1 else f'{name}.{self.names[name]}'

    def clip(self, shapes, inverted):
        """The attribute that keeps what is inside of the shapes (path data), or outside of each."""
        name = f'clip{len(self.defs)}'
        page = f'M0 0H{self.width}V{self.height}H0z' if inverted else ''
        self.defs.append(f'<clipPath id="{name}">' + ''.join(
            f'<path clip-rule="{"evenodd" if inverted else "nonzero"}" d="{page}{data}"/>' for data in shapes) +
            '</clipPath>')
        return f'clip-path="url(#{name})"'


def path_data(points, closed=True):
    return 'M' + 'L'.join('%.2f %.2f' % tuple(at[:2]) for at in points) + ('z' if closed else '')


def ribbon(points, radii, closed, flat):
    """The area of a line whose radius changes, as path data: quads between discs that all turn the same way."""
    parts = []
    count = len(points)
    for i, (x, y) in enumerate(points):
        r = radii[i]
        if not (flat and not closed and i in (0, count - 1)):
            parts.append(f'M{x - r:.2f} {y:.2f}a{r:.2f} {r:.2f} 0 1 1 {2 * r:.2f} 0a{r:.2f} {r:.2f} 0 1 1 {-2 * r:.2f} 0z')
        if i + 1 == count and not closed:
            break
        u, v = points[(i + 1) % count]
        q, length = radii[(i + 1) % count], math.hypot(u - x, v - y)
        if length > 1e-3:
            nx, ny = (v - y) / length, (x - u) / length
            parts.append(path_data([(x + nx * r, y + ny * r), (u + nx * q, v + ny * q),
                                    (u - nx * q, v - ny * q), (x - nx * r, y - ny * r)]))
    return ''.join(parts)


def gradient(page, material, stroke, placed, colour_of):
    """The id of the gradient of a fill; Blender mixes it in linear light, hence so many stops."""
    (u0, v0), rows = stroke.uv[0], []
    for other in range(1, len(placed)):  # two edges that are not parallel give the map from texture to page
        rows.append((stroke.uv[other][0] - u0, stroke.uv[other][1] - v0,
                     placed[other][0] - placed[0][0], placed[other][1] - placed[0][1]))
    suu, suv, svv = (sum(r[i] * r[j] for r in rows) for i, j in ((0, 0), (0, 1), (1, 1)))
    det = suu * svv - suv * suv
    if det < 1e-9:
        return None
    columns = []
    for k in (2, 3):
        a, b = (sum(r[i] * r[k] for r in rows) for i in (0, 1))
        columns.append(((a * svv - b * suv) / det, (b * suu - a * suv) / det))
    (a, c), (b, d) = columns
    e, f = placed[0][0] - a * u0 - c * v0, placed[0][1] - b * u0 - d * v0
    # Blender shifts the texture, turns and scales it, and puts its middle at .5, .5
    cosine, sine = math.cos(material.texture_angle), math.sin(material.texture_angle)
    sx, sy = material.texture_scale
    turn = (cosine * sx, sine * sx, -sine * sy, cosine * sy)
    px = -0.5 * (turn[0] + turn[2]) - material.texture_offset[0]
    py = -0.5 * (turn[1] + turn[3]) - material.texture_offset[1]
    numbers = (a * turn[0] + c * turn[1], b * turn[0] + d * turn[1], a * turn[2] + c * turn[3],
               b * turn[2] + d * turn[3], a * px + c * py + e, b * px + d * py + f)
    ends = [(material.fill_color, material.mix_color)[i != material.flip] for i in (0, 1)]
    solid, factor = colour_of(ends[0]), material.mix_factor  # tints are of the share that is no gradient
    stops = ''.join(f'<stop offset="{i / 32}" stop-color="{srgb(mixed(mixed(*ends, i / 32), solid, factor))}" '
                    f'stop-opacity="{ends[0][3] + (ends[1][3] - ends[0][3]) * i / 32 * (1 - factor):.3f}"/>'
                    for i in range(33))
    name, radial = f'gradient{len(page.defs)}', material.gradient_type == 'RADIAL'
    shape = 'cx="0.5" cy="0.5" r="0.5"' if radial else 'x1="0" y1="0" x2="1" y2="0"'
    kind = 'radialGradient' if radial else 'linearGradient'
    page.defs.append(f'<{kind} id="{name}" gradientUnits="userSpaceOnUse" {shape} gradientTransform="matrix'
                     f'({" ".join("%.5g" % n for n in numbers)})">{stops}</{kind}>')
    return name


class Shape:
    """A stroke on the page: path data of its fill and its line, and what they are painted with."""

    def __init__(self, page, matrix, layer, stroke):
        self.fill = self.line = self.data = ''
        material, placed = stroke.material, [page.place(matrix @ point.co) for point in stroke.points]
        self.seen = bool(material and placed and None not in placed)
        if None in placed and any(placed):
            page.lost.add('strokes that reach behind the camera: none')
        if not self.seen:
            return
        flat = [at[:2] for at in placed]
        tint = lambda colour: mixed(colour, layer.tint, layer.tint[3])
        self.fill_hole = material.show_fill and material.use_fill_holdout
        self.line_hole = material.show_stroke and material.use_stroke_holdout
        if material.show_fill and len(flat) > 2:
            own = lambda colour: tint(mixed(colour, stroke.mix, stroke.mix[3]))
            name = None
            if material.fill_style == 'GRADIENT' and stroke.uv:
                name = gradient(page, material, stroke, placed, own)
            if material.fill_style != 'SOLID' and not name:
                page.lost.add('textures and gradients of fills that have no place on the page: their first colour')
            paint = f'url(#{name})' if name else srgb(own(material.fill_color))
            opacity = stroke.fill_opacity * (1 if name else material.fill_color[3])
            self.data = path_data(flat)
            self.fill = f'fill="{paint}" fill-opacity="{opacity:.3f}"'
        if material.show_stroke:
            self.set_line(page, matrix, stroke, material, placed, flat, tint)

    def set_line(self, page, matrix, stroke, material, placed, flat, tint):
        scale = abs(matrix.determinant()) ** (1 / 3)
        self.radii = [-p.radius if p.radius < 0 else max(p.radius * scale * page.px_per_m(at[2]), 0.01)
                      for p, at in zip(stroke.points, placed)]
        mix, opacity = mean(p.mix for p in stroke.points), mean((p.opacity,) for p in stroke.points)[0]
        if any(abs(p.mix[i] - mix[i]) > 0.05 for p in stroke.points for i in range(4)):
            page.lost.add('colours that change along a line: their mean')
        if material.mode != 'LINE' or material.stroke_style != 'SOLID':
            page.lost.add('lines of dots, boxes and textures: plain lines')
        self.ribbon = lambda: ribbon(flat, self.radii, stroke.closed, stroke.flat)
        colour = srgb(tint(mixed(material.color, mix, mix[3])))
        opacity *= material.color[3]
        if max(self.radii) > 1.05 * min(self.radii):
            self.line = f'd="{self.ribbon()}" fill="{colour}" fill-opacity="{opacity:.3f}"'
        else:
            self.line = (f'd="{path_data(flat, stroke.closed)}" fill="none" stroke="{colour}" '
                         f'stroke-width="{2 * mean((r,) for r in self.radii)[0]:.2f}" stroke-opacity="{opacity:.3f}" '
                         f'stroke-linecap="{"butt" if stroke.flat else "round"}" stroke-linejoin="round"')

    def area(self):
        """Path data of all that the stroke covers."""
        return [data for data in (self.data, self.line and self.ribbon()) if data]

    def elements(self, name):
        if self.fill and not self.fill_hole:
            yield f'<path id="{name}-fill" d="{self.data}" {self.fill}/>'
        if self.line and not self.line_hole:
            yield f'<path id="{name}-line" {self.line}/>'


BLENDS = {'MULTIPLY': 'multiply', 'HARDLIGHT': 'hard-light'}


def object_svg(page, thing, matrix):
    """The group of an object: its layers in their order."""
    layers = list(LAYERS[thing.type](thing))
    shapes = {layer.name: [Shape(page, matrix @ layer.matrix if layer.matrix else matrix, layer, stroke)
                           for stroke in layer.strokes] for _, layer in layers}
    visible = {layer.name for hidden, layer in layers if not hidden}
    below = []  # finished layers
    if getattr(thing, 'shader_effects', None) and any(effect.show_viewport for effect in thing.shader_effects):
        page.lost.add('effects of objects: none')
    for hidden, layer in layers:
        if hidden:
            continue
        marks = []
        for n, shape in enumerate(shapes[layer.name]):
            if not shape.seen:
                continue
            for hole in ([shape.data] if shape.fill_hole else []) + ([shape.ribbon()] if shape.line_hole else []):
                clip = page.clip([hole], True)
                below = [f'<g {clip}>', *below, '</g>'] if below else []
                marks = [f'<g {clip}>', *marks, '</g>'] if marks else []
            marks += shape.elements(page.id(thing.name, layer.name, n))
        style = f' style="mix-blend-mode:{BLENDS[layer.blend]}"' if layer.blend in BLENDS else ''
        if layer.blend not in (*BLENDS, 'REGULAR'):
            page.lost.add(f'layers that {layer.blend.lower()}: laid over')
        if layer.lights and any(o.type == 'LIGHT' for o in page.scene.objects):
            page.lost.add('lights: the colours of materials')
        marks = [f'<g inkscape:groupmode="layer" inkscape:label={quoteattr(layer.name)} '
                 f'opacity="{layer.opacity:.3f}"{style}>', *marks, '</g>']
        masks = [(name, inverted) for name, inverted in layer.masks if name in visible - {layer.name}]
        kept = [data for name, inverted in masks if not inverted
                for shape in shapes[name] if shape.seen for data in shape.area()]
        clips = [page.clip(kept, False)] if any(not inverted for _, inverted in masks) else []
        clips += [page.clip([data], True) for name, inverted in masks if inverted
                  for shape in shapes[name] if shape.seen for data in shape.area()]
        for clip in clips:
            marks = [f'<g {clip}>', *marks, '</g>']
        below += marks
    return [f'<g inkscape:label={quoteattr(thing.name)}>', *below, '</g>']


def frame_svg(context, lost):
    """The scene's current frame as text. Adds to the set `lost` what SVG cannot say."""
    page = Page(context.scene)
    camera = context.scene.camera.matrix_world.translation
    groups = []
    for one in context.evaluated_depsgraph_get().object_instances:  # modifiers and instances are done
        if one.object.type in LAYERS and not one.object.hide_render:
            matrix = one.matrix_world.copy()
            groups.append(((matrix.translation - camera).length, object_svg(page, one.object, matrix)))
    groups.sort(key=lambda group: -group[0])  # far ones first
    lost |= page.lost
    head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{page.width}" height="{page.height}"'
            f' viewBox="0 0 {page.width} {page.height}"'
            ' xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">')
    defs = ['<defs>', *page.defs, '</defs>'] if page.defs else []
    return '\n'.join([head, *defs, *(line for _, group in groups for line in group), '</svg>\n'])


def export_frames(context, folder):
    """Writes every frame of the scene. Returns their folder's pattern, and what SVG could not say."""
    scene = context.scene
    if not scene.camera:
        raise RuntimeError('The scene has no camera, through which the drawing is seen.')
    if not any(o.type in LAYERS and o.visible_get() and not o.hide_render for o in scene.objects):
        raise RuntimeError('There is no Grease Pencil to be seen in the scene.')
    os.makedirs(folder, exist_ok=True)
    before, lost = scene.frame_current, set()
    for frame in range(scene.frame_start, scene.frame_end + 1, scene.frame_step):
        scene.frame_set(frame)
        with open(os.path.join(folder, f'frame_{frame:04d}.svg'), 'w', encoding='utf-8') as file:
            file.write(frame_svg(context, lost))
    scene.frame_set(before)
    return os.path.join(folder.replace('%', '%%'), 'frame_%04d.svg'), sorted(lost)


# ---- the program ---------------------------------------------------------------------------------

def command(settings, scene, frames, output):
    style = settings.other_style or settings.style
    words = [settings.program, frames, '--style', style, '--detail', settings.detail, '--output', output,
             '--frames', f'{scene.frame_start}-{scene.frame_end}x{scene.frame_step}',
             '--background', 'none', '--progress', 'json', '--overwrite']
    return words + shlex.split(settings.options)


class Painting:
    """The program at work; `line` is what it said last, `error` why it ended."""

    def __init__(self, words):
        self.line, self.error = 'Fluidy: starts', ''
        try:
            self.process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
        except OSError as problem:
            raise RuntimeError(f'{words[0]}: {problem.strerror}. Install fluidy-svg, '
                               'or name the program in the panel.') from problem
        self.thread = threading.Thread(target=self.listen)
        self.thread.start()

    def listen(self):
        for line in self.process.stderr:
            try:
                said = json.loads(line)
            except ValueError:
                said = {'error': line.strip()}
            self.error = said.get('error', self.error)
            if 'stage' in said:
                self.line = f"Fluidy: {said['share']:.0%}, {said['stage']}, frame {said['frame']}"

    def is_over(self):
        return self.process.poll() is not None

    def finish(self):
        self.thread.join()
        if self.process.wait() != 0:
            raise RuntimeError(self.error or 'fluidy-svg was interrupted')


# ---- what becomes of the frames --------------------------------------------------------------------

def load_sequence(scene, pattern):
    """The painted frames as an image, and how many there are."""
    image = bpy.data.images.load(pattern % scene.frame_start, check_existing=False)
    image.source = 'SEQUENCE'
    image.name = 'Fluidy'
    return image, scene.frame_end


def set_user(user, scene, duration):
    user.frame_duration = duration
    user.frame_start = scene.frame_start
    user.frame_offset = scene.frame_start - 1


def add_plane(context, pattern):
    """A plane that fills the camera's picture, as far away as the nearest drawing."""
    scene = context.scene
    camera = scene.camera
    image, duration = load_sequence(scene, pattern)
    material = bpy.data.materials.new('Fluidy')
    material.use_nodes, material.blend_method = True, 'BLEND'
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    picture, light, clear = (nodes.new('ShaderNode' + kind) for kind in
                             ('TexImage', 'Emission', 'BsdfTransparent'))
    mix, out = nodes.new('ShaderNodeMixShader'), nodes.new('ShaderNodeOutputMaterial')
    picture.image, picture.image_user.use_auto_refresh = image, True
    set_user(picture.image_user, scene, duration)
    links.new(picture.outputs['Color'], light.inputs['Color'])
    links.new(picture.outputs['Alpha'], mix.inputs[0])
    links.new(clear.outputs[0], mix.inputs[1])
    links.new(light.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], out.inputs['Surface'])
    mesh = bpy.data.meshes.new('Fluidy')
    corners = camera.data.view_frame(scene=scene)  # top right, bottom right, bottom left, top left
    mesh.from_pydata([tuple(corner) for corner in corners], [], [(0, 3, 2, 1)])
    uv = mesh.uv_layers.new()
    place = {0: (1, 1), 1: (1, 0), 2: (0, 0), 3: (0, 1)}
    for loop in mesh.loops:
        uv.data[loop.index].uv = place[loop.vertex_index]
    mesh.materials.append(material)
    plane = bpy.data.objects.new('Fluidy', mesh)
    plane.parent = camera
    scene.collection.objects.link(plane)
    return plane


def add_node(context, pattern):
    """An image node in the compositor, connected to the output if nothing is."""
    scene = context.scene
    scene.use_nodes = True
    tree = scene.node_tree
    image, duration = load_sequence(scene, pattern)
    node = tree.nodes.new('CompositorNodeImage')
    node.image, node.use_auto_refresh = image, True
    set_user(node, scene, duration)
    node.label = 'Fluidy'
    return node


LOADERS = {'PLANE': add_plane, 'COMPOSITOR': add_node, 'FILES': lambda context, pattern: None}


# ---- Blender's side --------------------------------------------------------------------------------

class FluidySettings(bpy.types.PropertyGroup):
    style: EnumProperty(name='Style', items=[(s, s.replace('-', ' ').capitalize(), '') for s in STYLES])
    other_style: StringProperty(name='Another style', description='By name or folder')
    detail: EnumProperty(name='Quality', items=[(d, d.capitalize(), '') for d in ('draft', 'normal', 'fine', 'finest')])
    result: EnumProperty(name='Result', items=[
        ('PLANE', 'Image plane', 'A plane before the camera'),
        ('COMPOSITOR', 'Compositor', 'An image node'),
        ('FILES', 'Files alone', 'Frames in the folder')])
    folder: StringProperty(name='Folder', subtype='DIR_PATH', default='//fluidy/')
    options: StringProperty(name='More options', description='As in man fluidy-svg')
    program: StringProperty(name='Program', default='fluidy-svg')


class FLUIDY_OT_paint(bpy.types.Operator):
    """Paint the Grease Pencil frames of the scene"""
    bl_idname, bl_label = 'fluidy.paint', 'Paint'
    bl_options = {'REGISTER'}

    def start(self, context):
        settings = context.scene.fluidy
        folder = bpy.path.abspath(settings.folder)
        self.pattern = os.path.join(folder.replace('%', '%%'), 'painted_%04d.png')
        frames, lost = export_frames(context, os.path.join(folder, 'drawing'))
        if lost:
            self.report({'WARNING'}, 'Drawn otherwise, since SVG cannot say it: ' + '; '.join(lost))
        self.painting = Painting(command(settings, context.scene, frames, self.pattern))

    def end(self, context):
        self.painting.finish()
        LOADERS[context.scene.fluidy.result](context, self.pattern)

    def execute(self, context):
        try:
            self.start(context)
            self.end(context)
        except RuntimeError as problem:
            self.report({'ERROR'}, str(problem))
            return {'CANCELLED'}
        return {'FINISHED'}

    def invoke(self, context, event):
        try:
            self.start(context)
        except RuntimeError as problem:
            self.report({'ERROR'}, str(problem))
            return {'CANCELLED'}
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {'RUNNING_MODAL'}

    def modal(self, context, event):
        if event.type == 'ESC':
            self.painting.process.terminate()
        if event.type != 'TIMER':
            return {'PASS_THROUGH'}
        context.workspace.status_text_set(self.painting.line + ' (Esc stops)')
        if not self.painting.is_over():
            return {'RUNNING_MODAL'}
        context.window_manager.event_timer_remove(self.timer)
        context.workspace.status_text_set(None)
        try:
            self.end(context)
        except RuntimeError as problem:
            self.report({'ERROR'}, str(problem))
            return {'CANCELLED'}
        return {'FINISHED'}


class FLUIDY_PT_panel(bpy.types.Panel):
    bl_label, bl_category = 'Fluidy', 'Fluidy'
    bl_space_type, bl_region_type = 'VIEW_3D', 'UI'

    def draw(self, context):
        for name in ('style', 'other_style', 'detail', 'result', 'folder', 'options', 'program'):
            self.layout.prop(context.scene.fluidy, name)
        self.layout.operator('fluidy.paint')


CLASSES = (FluidySettings, FLUIDY_OT_paint, FLUIDY_PT_panel)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.fluidy = bpy.props.PointerProperty(type=FluidySettings)


def unregister():
    del bpy.types.Scene.fluidy
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)


if __name__ == '__main__':
    register()
