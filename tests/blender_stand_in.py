"""Tries the Blender add-on without Blender: a scene of 4.3's Grease Pencil, and one of 3.4's, drawn alike.

usage: blender_stand_in.py ADD-ON. The scenes have what the documentation of Blender's API says of both.
"""
import importlib.util
import sys
import types
from types import SimpleNamespace as Thing


class Vector(tuple):
    def __sub__(self, other):
        return Vector(a - b for a, b in zip(self, other))

    @property
    def length(self):
        return sum(a * a for a in self) ** 0.5


class Matrix:
    """A scale and a shift."""

    def __init__(self, scale=1, shift=(0, 0, 0)):
        self.scale, self.translation = scale, Vector(shift)

    def __matmul__(self, other):
        if isinstance(other, Matrix):
            return Matrix(self.scale * other.scale, self @ other.translation)
        return Vector(self.scale * a + b for a, b in zip(other, self.translation))

    def inverted(self):
        return Matrix(1 / self.scale, [-a / self.scale for a in self.translation])

    def determinant(self):
        return self.scale ** 3

    def copy(self):
        return self


for name in ('bpy', 'bpy.types', 'bpy.props', 'bpy_extras', 'bpy_extras.object_utils'):
    sys.modules[name] = types.ModuleType(name)
bpy = sys.modules['bpy']
bpy.types = Thing(PropertyGroup=object, Operator=object, Panel=object)
sys.modules['bpy.props'].EnumProperty = sys.modules['bpy.props'].StringProperty = lambda **_: None
# the camera sees 10 m x 10 m around the origin from y = -10, without perspective
sys.modules['bpy_extras.object_utils'].world_to_camera_view = lambda scene, camera, at: \
    Thing(x=at[0] / 10 + 0.5, y=at[2] / 10 + 0.5, z=at[1] + 10)
spec = importlib.util.spec_from_file_location('fluidy_svg', sys.argv[1])
addon = importlib.util.module_from_spec(spec)
spec.loader.exec_module(addon)

SQUARE = [(-2, 0, -2), (2, 0, -2), (2, 0, 2), (-2, 0, 2)]


def material(**own):
    one = dict(hide=False, show_fill=True, show_stroke=False, fill_color=(1, 0, 0, 1), color=(0, 0, 0, 1),
               fill_style='SOLID', use_fill_holdout=False, use_stroke_holdout=False, mode='LINE', stroke_style='SOLID')
    return Thing(material=Thing(grease_pencil=Thing(**{**one, **own})))


MATERIALS = [material(), material(show_fill=False, show_stroke=True), material(use_fill_holdout=True)]


def new_stroke(index, points, radii, **own):
    each = [Thing(position=Vector(p), radius=r, opacity=1, vertex_color=(0, 0, 1, 0.5)) for p, r in zip(points, radii)]
    return Thing(**{**dict(points=each, cyclic=index != 1, material_index=index, fill_color=(0, 0, 0, 0), fill_opacity=1,
                           start_cap=0), **own})


def old_stroke(index, points, radii, fill_color=(0, 0, 0, 0)):
    each = [Thing(co=Vector(p), pressure=r, strength=1, vertex_color=(0, 0, 1, 0.5), uv_fill=(0, 0))
            for p, r in zip(points, radii)]
    return Thing(points=each, use_cyclic=index != 1, material_index=index, vertex_color_fill=fill_color,
                 line_width=2000, start_cap_mode='ROUND')


ARM = Matrix(2) @ Matrix(1, (1, 0, 0))  # of a bone, in the world
PARENT = Thing(matrix_world=Matrix(2), pose=Thing(bones={'arm': Thing(matrix=Matrix(1, (1, 0, 0)))}))


def layer(name, strokes, new, masks=(), hide=False):
    own = dict(hide=hide, opacity=0.5, tint_color=(0, 0, 0), tint_factor=0, blend_mode='MULTIPLY', use_lights=False,
               mask_layers=[Thing(name=m, invert=True, hide=False) for m in masks])
    if new:
        return Thing(name=name, current_frame=lambda: Thing(drawing=Thing(strokes=strokes)), matrix_local=Matrix(),
                     parent=PARENT, parent_bone='arm', matrix_parent_inverse=ARM.inverted(), use_masks=bool(masks), radius_offset=0, **own)
    return Thing(info=name, active_frame=Thing(strokes=strokes), line_change=0,
                 use_mask_layer=bool(masks), **own)


def drawn(new):
    stroke = new_stroke if new else old_stroke
    small = [(x / 4, y, z / 4) for x, y, z in SQUARE]
    layers = [layer('Back', [stroke(0, SQUARE, [1] * 4, fill_color=(0, 1, 0, 1)), stroke(2, small, [1] * 4)], new),
              layer('Lines', [stroke(1, SQUARE, [0.1] * 4), stroke(1, SQUARE, [0.1, 0.1, 0.3, 0.1])], new,
                    ['Back', 'Hidden', 'Lines']),
              layer('Hidden', [stroke(0, SQUARE, [1] * 4)], new, hide=True)]
    data = Thing(layers=layers, pixel_factor=1, stroke_thickness_space='WORLDSPACE')
    figure = Thing(type='GREASEPENCIL' if new else 'GPENCIL', name='a figure', data=data, material_slots=MATERIALS,
                   shader_effects=[], hide_render=False, matrix_world=Matrix())
    corners = [Thing(x=5, z=-1), Thing(x=5, z=-1), Thing(x=-5, z=-1), Thing(x=-5, z=-1)]
    camera = Thing(data=Thing(type='ORTHO', view_frame=lambda scene: corners), matrix_world=Matrix(1, (0, -10, 0)))
    render = Thing(resolution_x=100, resolution_y=100, resolution_percentage=100)
    graph = Thing(object_instances=[Thing(object=figure, matrix_world=Matrix())])
    lost = set()
    text = addon.frame_svg(Thing(scene=Thing(render=render, camera=camera, objects=[]),
                                 evaluated_depsgraph_get=lambda: graph), lost)
    assert not lost, lost
    return text


first, second = drawn(True), drawn(False)
assert first == second, (first, second)
for part in ('fill="#00ff00"',  # a fill has the vertex colour
             '<g clip-path="url(#clip0)">\n<path id="a_figure-Back-0-fill"',  # a holdout is cut out of what lies below
             'clip0"><path clip-rule="evenodd" d="M0 0H100V100H0zM45.00 55.00L',
             'stroke="#0000bc" stroke-width="2.00"',  # a line has its vertex colour and its width
             'a3.00 3.00 0 1 1 6.00 0',  # or one that changes
             'id="a_figure-Lines-1-line"', 'mix-blend-mode:multiply', 'opacity="0.500"',
             'evenodd" d="M0 0H100V100H0zM30.00 70.00L'):  # an inverted mask
    assert part in first, (part, first)
assert first.count('<clipPath') == 3, first  # a hidden layer masks no other, nor does a layer itself
print('both are drawn alike')
