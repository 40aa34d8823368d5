"""Paints Grease Pencil with fluidy-svg.

The frames of the scene are written as SVG files that all have the page of the render: Blender's own
export gives each frame a page of its own, so that a drawing slides. The program paints them, and the
painted frames come back as an image plane before the camera or into the compositor.
"""
import json
import os
import shlex
import subprocess
import threading
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
          'backruns', 'pastel', 'pools', 'batik', 'suminagashi', 'smoke']
LINE_M = 0.001  # world size of a line's thickness of one


# ---- Grease Pencil to SVG ------------------------------------------------------------------------

def srgb(linear):
    """A linear colour of a material as #rrggbb."""
    levels = []
    for value in linear[:3]:
        value = min(max(value, 0), 1)
        light = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
        levels.append(round(255 * light))
    return '#%02x%02x%02x' % tuple(levels)


class Page:
    """The picture that the camera takes, in pixels."""

    def __init__(self, scene):
        render = scene.render
        self.scene, self.camera = scene, scene.camera
        self.width = render.resolution_x * render.resolution_percentage // 100
        self.height = render.resolution_y * render.resolution_percentage // 100

    def place(self, point):
        """x, y and depth of a point of the world; None behind the camera."""
        at = world_to_camera_view(self.scene, self.camera, point)
        return (at.x * self.width, (1 - at.y) * self.height, at.z) if at.z > 0 else None

    def px_per_m(self, depth):
        left, right = self.camera.data.view_frame(scene=self.scene)[2].x, \
            self.camera.data.view_frame(scene=self.scene)[0].x
        frame_m = abs(right - left)
        if self.camera.data.type == 'ORTHO':
            return self.width / frame_m
        return self.width / frame_m * -self.camera.data.view_frame(scene=self.scene)[0].z / depth


def stroke_svg(page, matrix, stroke, material):
    """The element of a stroke; '' where it is not seen."""
    placed = [page.place(matrix @ point.co) for point in stroke.points]
    if not placed or None in placed:
        return ''
    points = ' '.join('%.2f,%.2f' % at[:2] for at in placed)
    closed = stroke.use_cyclic or material.show_fill
    paint = ['fill="none"']
    if material.show_fill:
        paint = [f'fill="{srgb(material.fill_color)}" fill-opacity="{material.fill_color[3]:.3f}"']
    if material.show_stroke:
        pressure = sum(point.pressure for point in stroke.points) / len(stroke.points)
        scale = sum(abs(value) for value in matrix.to_scale()) / 3
        depth = sum(at[2] for at in placed) / len(placed)
        width = stroke.line_width * LINE_M * pressure * scale * page.px_per_m(depth)
        strength = sum(point.strength for point in stroke.points) / len(stroke.points)
        paint.append(f'stroke="{srgb(material.color)}" stroke-width="{width:.2f}" '
                     f'stroke-opacity="{material.color[3] * strength:.3f}" '
                     'stroke-linecap="round" stroke-linejoin="round"')
    return f'<{"polygon" if closed else "polyline"} points="{points}" {" ".join(paint)}/>'


def layer_svg(page, thing, layer):
    frame = layer.active_frame
    if layer.hide or not frame:
        return ''
    matrix = thing.matrix_world @ layer.matrix_layer
    lines = [f'<g inkscape:groupmode="layer" inkscape:label={quoteattr(layer.info)}'
             f' opacity="{layer.opacity:.3f}">']
    for stroke in frame.strokes:
        slot = thing.material_slots[stroke.material_index].material
        if slot and slot.grease_pencil and not slot.grease_pencil.hide:
            lines.append(stroke_svg(page, matrix, stroke, slot.grease_pencil))
    return '\n'.join(lines + ['</g>'])


def frame_svg(context):
    """The scene's current frame as text."""
    page = Page(context.scene)
    graph = context.evaluated_depsgraph_get()
    seen = [o.evaluated_get(graph) for o in context.scene.objects if o.type == 'GPENCIL' and o.visible_get()]
    camera = context.scene.camera.matrix_world.translation
    seen.sort(key=lambda o: -(o.matrix_world.translation - camera).length)  # far ones first
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{page.width}" height="{page.height}"'
             f' viewBox="0 0 {page.width} {page.height}"'
             ' xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">']
    for thing in seen:
        lines.append(f'<g inkscape:label={quoteattr(thing.name)}>')
        lines += [layer_svg(page, thing, layer) for layer in thing.data.layers]
        lines.append('</g>')
    return '\n'.join(lines + ['</svg>\n'])


def export_frames(context, folder):
    """Writes every frame of the scene. Returns their folder's pattern."""
    scene = context.scene
    if not scene.camera:
        raise RuntimeError('The scene has no camera, through which the drawing is seen.')
    if not any(o.type == 'GPENCIL' and o.visible_get() for o in scene.objects):
        raise RuntimeError('There is no Grease Pencil to be seen in the scene.')
    os.makedirs(folder, exist_ok=True)
    before = scene.frame_current
    for frame in range(scene.frame_start, scene.frame_end + 1, scene.frame_step):
        scene.frame_set(frame)
        with open(os.path.join(folder, f'frame_{frame:04d}.svg'), 'w', encoding='utf-8') as file:
            file.write(frame_svg(context))
    scene.frame_set(before)
    return os.path.join(folder, 'frame_%04d.svg')


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
        self.pattern = os.path.join(folder, 'painted_%04d.png')
        frames = export_frames(context, os.path.join(folder, 'drawing'))
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
