"""The legal forms in which a format can describe a body, for the problem `cusps`.

A form says one thing of the models of a description in other words: the rotation of an inertial
frame, the place of a child, the inertia itself as the shape of a solid, or the units. The rest of a
model does not change. `README.md` has the table of forms, and says what is left out.
"""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial

from symtop_ros.physics import Body, State, Top
from symtop_ros.run.models import FORMATS
from symtop_ros.run.models.descriptions import (
    BACK,
    MATRIX,
    ROLL_PITCH_YAW,
    ROLL_PITCH_YAW_BACK,
    TURN,
    describe,
    join,
)
from symtop_ros.run.models.urdf import MASSLESS

Edits = Mapping[str, str]  # what stands in a model, and what says the same
QUATERNION = f'quat="{join(BACK)}"'
RADIAN = '<compiler angle="radian"/>'


@dataclass(frozen=True)
class Solid:
    """A homogeneous cylinder that has the mass and the moments of a body.

    m r^2/2 = Iz and m (3 r^2 + h^2)/12 = Ix; doubles round both by a few units in the last place.
    """

    body: Body

    @property
    def radius(self) -> float:
        """Radius in m."""
        return math.sqrt(2 * self.body.Iz / self.body.mass)

    @property
    def half(self) -> float:
        """Half of the height in m."""
        return math.sqrt((3 * self.body.Ix - 1.5 * self.body.Iz) / self.body.mass)

    @property
    def density(self) -> float:
        """Density in kg/m^3."""
        return self.body.mass / (2 * math.pi * self.radius * self.radius * self.half)

    @property
    def size(self) -> str:
        """Radius and half of the height, as MJCF has them."""
        return join((self.radius, self.half))


@dataclass(frozen=True)
class Models:
    """The models of a top in its descriptions, and what forms take from them."""

    top: Top
    start: State
    body: Body

    def write(self, description: str, form: str) -> str:
        """Return a model in a description, which is empty for the body's own frame."""
        described = [describe(description, self.body)] if description else []
        return FORMATS[form](self.top, self.start, self.body, *described)

    @property
    def solid(self) -> Solid:
        """The cylinder that has these moments."""
        return Solid(self.body)

    @property
    def centre(self) -> str:
        """The centre of mass in the turned frame."""
        return join(describe("turned", self.body).link(self.body).centre)

    @property
    def child(self) -> str:
        """The place of the child of `nested_half` in the frame of the link."""
        return join(describe("nested_half", self.body).place_child())


def write_forms(top: Top, start: State, body: Body) -> dict[tuple[str, str], str]:
    """Return the models by the names of forms and formats."""
    models = Models(top, start, body)
    return {key: edit(models) for key, edit in FORMS.items()}


def change(text: str, edits: Edits) -> str:
    """Return a text in which parts are replaced; each must occur exactly once.

    Raises
    ------
    ValueError
        If a part is missing or is there several times.
    """
    for old, new in edits.items():
        if text.count(old) != 1:
            raise ValueError(f"a model must have {old} once, got {text.count(old)}")
        text = text.replace(old, new)
    return text


def _edit_mjcf(attribute: str, compiler: str = RADIAN) -> Callable[[Models], str]:
    """Return a form of the rotation of an inertial frame in MJCF."""
    edits = {QUATERNION: attribute, RADIAN: compiler}
    return lambda models: change(models.write("inertial", "mjcf"), edits)


def _fill_mjcf(
    geoms: Callable[[Models], str], compiler: str = RADIAN, defaults: str = "", inertial: str = ""
) -> Callable[[Models], str]:
    """Return a form that has solids in place of moments, and maybe moments that do not count."""

    def write(models: Models) -> str:
        text = models.write("inertial", "mjcf")
        (old,) = re.findall("<inertial .*/>", text)
        edits = {old: inertial + geoms(models), RADIAN: compiler}
        if defaults:
            filled = defaults.format(size=models.solid.size, mass=repr(models.body.mass))
            edits |= {"  <worldbody>": f"{filled}  <worldbody>"}
            edits |= {'<body name="top"': '<body name="top" childclass="steel"'}
        return change(text, edits)

    return write


def _describe_cylinder(models: Models) -> str:
    place = f'pos="{models.centre}" {QUATERNION}'
    return f'<geom type="cylinder" {place} size="{models.solid.size}" mass="{models.body.mass!r}"/>'


def _describe_ends(models: Models) -> str:
    """Return a cylinder from one end to the other."""
    solid = models.solid
    axis = [float(each) for each in MATRIX[2]]
    heights = models.body.arm - solid.half, models.body.arm + solid.half
    ends = join(height * each for height in heights for each in axis)
    shape = f'type="cylinder" fromto="{ends}" size="{solid.radius!r}"'
    return f'<geom {shape} density="{solid.density!r}"/>'


# The class of the body says the shape, the one above it what a body of steel would weigh.
CLASSES = """\
  <default>
    <geom type="cylinder"/>
    <default class="heavy">
      <geom size="{size}" density="7850"/>
      <default class="steel">
        <geom mass="{mass}"/>
      </default>
    </default>
  </default>
"""
# With inertiafromgeom="true" it does not count: a body of 1 kg with other moments elsewhere.
OVERRIDDEN = '<inertial pos="0 0 1" mass="1" diaginertia="1 1 1"/>\n      '


def _frame_mjcf(models: Models) -> str:
    """Return `nested_half` with its child in two frames: one moves, the other turns."""
    text = models.write("nested_half", "mjcf")
    place = f'pos="{models.child}" quat="{join(map(float, TURN))}"'
    (child,) = re.findall(r' *<body name="part"(?:.*\n)*? *</body>\n', text)
    plain = change(child, {f" {place}": ""})
    turned = f'<frame euler="{join(ROLL_PITCH_YAW)}">'
    framed = f'      <frame pos="{models.child}">{turned}\n{plain}      </frame></frame>\n'
    return change(text, {child: framed, RADIAN: '<compiler angle="radian" eulerseq="XYZ"/>'})


def _edit_sdf(pose: str, angles: str) -> Callable[[Models], str]:
    """Return a form of the pose of an inertial frame in SDF."""

    def write(models: Models) -> str:
        old = f"<pose>{models.centre} {join(ROLL_PITCH_YAW_BACK)}</pose>"
        new = f"<pose {pose}>{models.centre} {angles}</pose>"
        return change(models.write("inertial", "sdf"), {old: new})

    return write


def _fill_sdf(models: Models) -> str:
    """Return a link whose inertia is computed from its collision."""
    solid = models.solid
    text = models.write("inertial", "sdf")
    (old,) = re.findall(r" *<inertial>(?:.*\n)*? *</inertial>", text)
    new = f"""\
        <inertial auto="true"/>
        <collision name="solid">
          <pose>{models.centre} {join(ROLL_PITCH_YAW_BACK)}</pose>
          <density>{solid.density!r}</density>
          <geometry><cylinder><radius>{solid.radius!r}</radius>\
<length>{2 * solid.half!r}</length></cylinder></geometry>
        </collision>"""
    return change(text, {old: new, '<sdf version="1.9">': '<sdf version="1.11">'})


def _frame_sdf(models: Models) -> str:
    """Return `nested_half` with its child relative to frames: one turns, the other moves."""
    old = f"<pose>{models.child} {join(ROLL_PITCH_YAW)}</pose>"
    frames = f"""\
      <frame name="moved" attached_to="top">
        <pose>{models.child} 0 0 0</pose>
      </frame>
      <frame name="turned">
        <pose relative_to="moved">0 0 0 {join(ROLL_PITCH_YAW)}</pose>
      </frame>
"""
    link = '      <link name="part">'
    edits = {old: '<pose relative_to="turned"/>', link: frames + link}
    return change(models.write("nested_half", "sdf"), edits)


def _nest_sdf(models: Models) -> str:
    """Return `nested_half` with its child in a model inside the model."""
    text = models.write("nested_half", "sdf")
    (link,) = re.findall(r' *<link name="part">(?:.*\n)*? *</link>\n', text)
    pose = f"{models.child} {join(ROLL_PITCH_YAW)}"
    moved = f'      <model name="inner">\n        <pose>{models.child} 0 0 0</pose>\n'
    turned = change(link, {f"<pose>{pose}": f"<pose>0 0 0 {join(ROLL_PITCH_YAW)}"})
    edits = {link: f"{moved}{turned}      </model>\n"}
    return change(text, edits | {"<child>part</child>": "<child>inner::part</child>"})


def _turn_urdf(models: Models) -> str:
    """Return the rotation of the inertial frame as a quaternion, which URDF 1.1 has."""
    w, *xyz = BACK
    edits = {
        f'rpy="{join(ROLL_PITCH_YAW_BACK)}"': f'quat_xyzw="{join((*xyz, w))}"',
        '<robot name="symtop">': '<robot name="symtop" version="1.1">',
    }
    return change(models.write("inertial", "urdf"), edits)


def _frame_urdf(models: Models) -> str:
    """Return `nested_half` with its child behind two fixed joints: one moves, the other turns."""
    # pybullet gives 1 kg to a link without inertia
    old = f"""\
<child link="top_part"/><origin xyz="{models.child}" rpy="{join(ROLL_PITCH_YAW)}"/>
  </joint>"""
    new = f"""\
<child link="top_moved"/><origin xyz="{models.child}"/>
  </joint>
  <link name="top_moved">
    {MASSLESS}
  </link>
  <joint name="turned" type="fixed">
    <parent link="top_moved"/><child link="top_part"/><origin rpy="{join(ROLL_PITCH_YAW)}"/>
  </joint>"""
    return change(models.write("nested_half", "urdf"), {old: new})


# Powers of centimetre and gram in fields of a stage; angles and axes have neither.
CENTIMETRES, GRAMS = 100, 1000
SCALES = {
    "gravityMagnitude": CENTIMETRES,
    "xformOp:translate": CENTIMETRES,
    "centerOfMass": CENTIMETRES,
    "velocity": CENTIMETRES,
    "mass": GRAMS,
    "diagonalInertia": GRAMS * CENTIMETRES**2,
}


def _scale_usd(models: Models) -> str:
    """Return a stage in centimetres and grams."""
    text = models.write("turned", "usd")
    for name, factor in SCALES.items():
        field = rf"(?<= )(\S*{name} = )(.*)"
        text, count = re.subn(field, partial(_scale, factor=factor), text)
        if count != 1:
            raise ValueError(f"a stage must have {name} once, got {count}")
    return change(
        text,
        {"kilogramsPerUnit = 1\n": "kilogramsPerUnit = 0.001\n"}
        | {"metersPerUnit = 1\n": "metersPerUnit = 0.01\n"},
    )


def _scale(found: re.Match[str], factor: float) -> str:
    numbers = re.sub(r"-?\d[^,)]*", lambda each: repr(float(each[0]) * factor), found[2])
    return found[1] + numbers


def _fill_usd(models: Models) -> str:
    """Return a stage whose body has a collider with a density in place of mass and moments."""
    text = models.write("turned", "usd")
    fields = "mass|centerOfMass|diagonalInertia|principalAxes"
    stated = re.findall(rf" *\w+ physics:(?:{fields}) = .*\n", text)
    solid = models.solid
    collider = f"""\

            def Cylinder "solid" (prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMassAPI"])
            {{
                double3 xformOp:translate = ({models.centre.replace(" ", ", ")})
                quatd xformOp:orient = ({join(BACK, ", ")})
                uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:orient"]
                double radius = {solid.radius!r}
                double height = {2 * solid.half!r}
                uniform token axis = "Z"
                float physics:density = {solid.density!r}
            }}
        }}
    }}
"""
    end = "        }\n    }\n"
    return change(text, dict.fromkeys(stated, "") | {end: collider})


def _frame_usd(models: Models) -> str:
    """Return a stage whose body is in two transforms: one turns, the other moves and turns back.

    The first turns by a quaternion, the second in degrees about x, y and z, one after the other.
    """
    text = models.write("", "usd")
    turned = describe("turned", models.body).begin(models.start)
    place = describe("offset", models.body).pivot
    away = [-each for each in turned.to_world(place).tolist()]
    orient = join(models.start.orientation.tolist(), ", ")
    back = f"""\
        def Xform "back"
        {{
        double3 xformOp:translate = ({join(place, ", ")})
        double3 xformOp:rotateXYZ = ({join(map(math.degrees, ROLL_PITCH_YAW_BACK), ", ")})
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]

        def Xform "top" ("""
    edits = {
        f"(0.0, 0.0, 0.0)\n        quatd xformOp:orient = ({orient})": (
            f"({join(away, ', ')})\n"
            f"        quatd xformOp:orient = ({join(turned.orientation.tolist(), ', ')})"
        ),
        '        def Xform "top" (': back,
        "        }\n    }\n\n    def Phys": "        }\n        }\n    }\n\n    def Phys",
        "start_top/top>": "start_top/back/top>",
    }
    return change(text, edits)


def _degrees(angles: Iterable[float]) -> str:
    return join(map(math.degrees, angles))


# Literals and square roots, which all machines round alike: the files always have the same bytes.
AXIS = [each / math.sqrt(0.51) for each in BACK[1:]]
ANGLE = 1.5907976603682872  # 2 arccos(0.7)
ROWS = [[float(each) for each in row] for row in MATRIX]  # the principal axes in the turned frame
FORMS: dict[tuple[str, str], Callable[[Models], str]] = {
    # the three rotations about fixed axes, and the same as rotations about axes that turn
    ("euler", "mjcf"): _edit_mjcf(
        f'euler="{join(ROLL_PITCH_YAW_BACK)}"', '<compiler angle="radian" eulerseq="XYZ"/>'
    ),
    ("degrees", "mjcf"): _edit_mjcf(
        f'euler="{_degrees(-each for each in ROLL_PITCH_YAW)}"', "<compiler/>"
    ),
    ("axisangle", "mjcf"): _edit_mjcf(f'axisangle="{join((*AXIS, ANGLE))}"'),
    ("xyaxes", "mjcf"): _edit_mjcf(f'xyaxes="{join((*ROWS[0], *ROWS[1]))}"'),
    ("zaxis", "mjcf"): _edit_mjcf(f'zaxis="{join(ROWS[2])}"'),
    ("solid", "mjcf"): _fill_mjcf(_describe_cylinder),
    ("ends", "mjcf"): _fill_mjcf(_describe_ends),
    ("inferred", "mjcf"): _fill_mjcf(
        _describe_cylinder, '<compiler angle="radian" inertiafromgeom="true"/>', inertial=OVERRIDDEN
    ),
    ("classes", "mjcf"): _fill_mjcf(
        lambda models: f'<geom pos="{models.centre}" {QUATERNION}/>', defaults=CLASSES
    ),
    ("frames", "mjcf"): _frame_mjcf,
    ("degrees", "sdf"): _edit_sdf('degrees="true"', _degrees(ROLL_PITCH_YAW_BACK)),
    ("quaternion", "sdf"): _edit_sdf('rotation_format="quat_xyzw"', join((*BACK[1:], BACK[0]))),
    ("solid", "sdf"): _fill_sdf,
    ("frames", "sdf"): _frame_sdf,
    ("submodel", "sdf"): _nest_sdf,
    ("quaternion", "urdf"): _turn_urdf,
    ("frames", "urdf"): _frame_urdf,
    ("units", "usd"): _scale_usd,
    ("solid", "usd"): _fill_usd,
    ("frames", "usd"): _frame_usd,
}
