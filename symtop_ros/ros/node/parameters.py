"""Declaration of the ROS parameters, requests to set them, and values of other requests.

Each has a type, because readers in C++ insist on it. Values are validated before rclpy sees them:
`publish_rate:=500` is accepted like `500.0`, and a bad value is refused with the message of the
package, at start-up as well as later.
"""

from collections.abc import Callable, Iterable, Sequence
from copy import copy
from functools import partial
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from std_srvs.srv import SetBool, Trigger

from symtop_ros.base.refusals import (
    RefusedError,
    attempt,
    find_nearest,
    refuse,
    show,
    validate_names,
)
from symtop_ros.run.session.services import ServiceKind
from symtop_ros.run.simulation.changes.requests import NOT_NUMBERS
from symtop_ros.run.simulation.presets import load_scene, scene_names
from symtop_ros.run.simulation.settings import PARAMETERS, Settings, override_scene

QOS = "qos_overrides."  # of topics, which declare these parameters themselves
Handler = Callable[[Any, Any], Any]  # of rclpy: from request and response to the response
# By the Python type of a default; the lists are vectors.
TYPES = {
    bool: Parameter.Type.BOOL,
    int: Parameter.Type.INTEGER,
    float: Parameter.Type.DOUBLE,
    str: Parameter.Type.STRING,
    list: Parameter.Type.DOUBLE_ARRAY,
}
KNOWN = [*PARAMETERS, "scene", "use_sim_time"]
GROUPS = {name.partition(".")[0] for name in PARAMETERS if "." in name}
MAX_COUNT = 1000  # parameters of a request; a file with all of them has a tenth
MAX_UNUSED = 5  # unknown names that are named: a file for /** may have those of many nodes
VALUE_FIELDS = (
    "bool_value",
    "integer_value",
    "double_value",
    "string_value",
    "bool_array_value",
    "integer_array_value",
    "double_array_value",
    "string_array_value",
)
# By the kind of a service: its ROS type, and how the argument of the request is read.
SERVICE_TYPES: dict[ServiceKind, tuple[type, Callable[[Any], Any]]] = {
    "named": (SetParametersAtomically, lambda request: read_values(request.parameters)),
    "switch": (SetBool, lambda request: bool(request.data)),
    "plain": (Trigger, lambda _: None),
}


def declare_parameters(node: Node) -> Settings:
    """Declare all parameters with the defaults of the scene; return their values."""
    name: object = node.declare_parameter(
        "scene",
        "cusps",
        _descriptor(
            "file in config/ with the defaults of all parameters",
            f"one of {', '.join(scene_names())}",
            read_only=True,
        ),
    ).value
    scene = load_scene(name)
    validate_names(scene, PARAMETERS, f"parameter in scene {name}")
    # /tf is shared by all tops, of other names or namespaces.
    defaults = {"top_frame": node.get_fully_qualified_name().lstrip("/"), **scene}
    overrides = _list_overrides(node).items()
    given = {
        key: each.value for key, each in overrides if key in PARAMETERS and each.value is not None
    }
    settings = Settings.from_values(override_scene(defaults, given))
    for key in PARAMETERS:
        _declare(node, _typed(key, settings.values[key]))
    _check_unknown_names(node)
    return settings


def _list_overrides(node: Node) -> dict[str, Parameter]:
    """Return what the command line, files and the constructor give, by name; declared or not.

    rclpy (7 and 9) has no public way: `declare_parameter` uses an override, of whatever type, only
    if its parameter is declared, so that an unknown name and one that a scene depends on would not
    be seen. With `automatically_declare_parameters_from_overrides` all of them would be declared,
    those of other nodes too, before they are validated.
    """
    overrides: dict[str, Parameter] = node._parameter_overrides
    return overrides


def _declare(node: Node, parameter: Parameter) -> None:
    """Declare a parameter of a type; from a value rclpy takes an empty list for one of bytes."""
    name = parameter.name
    entry = PARAMETERS[parameter.name]
    node.declare_parameter(
        name,
        parameter.type_,
        _descriptor(entry.description, entry.condition, read_only=False),
        ignore_override=True,
    )
    node.set_parameters([parameter])
    if entry.read_only:
        fixed = _descriptor(entry.description, entry.condition, read_only=True)
        fixed.type = parameter.type_.value
        node.set_descriptor(name, fixed)


def _typed(name: str, value: Any) -> Parameter:
    """Return a validated value as a ROS parameter."""
    kind = TYPES[type(PARAMETERS[name].default)]
    return Parameter(name, kind, list(value) if isinstance(value, tuple) else value)


def _check_unknown_names(node: Node) -> None:
    """Refuse unknown names in the groups of this node, and warn about others.

    A parameter file for /** holds the parameters of other nodes too.
    """
    unknown = [
        name
        for name in _list_overrides(node)
        if not (name in KNOWN or node.has_parameter(name) or name.startswith(QOS))
    ]
    for name in unknown:
        if name.partition(".")[0] in GROUPS:
            raise _refuse_name(name, KNOWN)
    _warn_of_unused(node, unknown, KNOWN)


def _refuse_name(name: str, known: Sequence[str]) -> RefusedError:
    """Return the refusal of an unknown parameter, with the known name that is most like it."""
    nearest = find_nearest(name, known, likeness=0.0)
    return refuse("parameter name", f"known (the nearest is {nearest})", name)


def warn_of_unused_qos(node: Node) -> None:
    """Warn about overrides of QoS for topics that there are not; call it when all are there."""
    overrides = (name for name in _list_overrides(node) if name.startswith(QOS))
    unused = [name for name in overrides if not node.has_parameter(name)]
    _warn_of_unused(node, unused, _list_qos(node))


def _list_qos(node: Node) -> list[str]:
    return [QOS + name for name in sorted(node.get_parameters_by_prefix(QOS.rstrip(".")))]


def _warn_of_unused(node: Node, unknown: list[str], known: list[str]) -> None:
    """Warn about the first unknown names, and of the number of the others."""
    for name in unknown[:MAX_UNUSED]:
        nearest = find_nearest(name, known, likeness=0.0)
        node.get_logger().warning(
            f"parameter {name!r} is unknown and not used (nearest: {nearest})"
        )
    more = len(unknown) - MAX_UNUSED
    if more > 0:
        node.get_logger().warning(f"{more} more parameters are unknown and not used")


def _descriptor(description: str, condition: str, read_only: bool) -> ParameterDescriptor:
    return ParameterDescriptor(
        description=description,
        additional_constraints=f"must be {condition}",
        read_only=read_only,
    )


def guard_parameters(node: Node, name: str, handler: Handler) -> Handler:
    """Return a handler of a service (full name) of parameters; those of others are unchanged.

    rclpy's own handlers raise an exception for unknown types, which would end the node, and refuse
    unknown names and wrong types in words that name neither. Ranges are only described, not
    declared: rclpy would refuse what is outside before we do.
    """

    def set_all(request: Any, response: Any) -> Any:
        response.result = _set(node, request.parameters, handler, SetParametersAtomically)
        return response

    def set_each(request: Any, response: Any) -> Any:
        is_read, reason = attempt(partial(refuse_too_many, request.parameters))
        response.results = [
            _set(node, [each], handler, SetParameters)
            if is_read
            else SetParametersResult(successful=False, reason=reason)
            for each in request.parameters
        ]
        return response

    def describe(request: Any, response: Any) -> Any:
        response = handler(request, response)
        response.descriptors = [_with_range(each) for each in response.descriptors]
        return response

    return {
        "set_parameters": set_each,
        "set_parameters_atomically": set_all,
        "describe_parameters": describe,
    }.get(name.rpartition("/")[2], handler)


def _with_range(descriptor: ParameterDescriptor) -> ParameterDescriptor:
    """Return a descriptor with the range of its parameter, of which rqt makes a slider."""
    entry = PARAMETERS.get(descriptor.name)
    if entry is None or entry.limits is None:
        return descriptor
    found = copy(descriptor)
    low, high = entry.limits
    if isinstance(entry.default, int):
        found.integer_range = [IntegerRange(from_value=int(low), to_value=int(high), step=1)]
    else:
        found.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return found


def _set(
    node: Node, parameters: Sequence[ParameterMessage], handler: Handler, service: Any
) -> SetParametersResult:
    try:
        refuse_too_many(parameters)
        refuse_unknown_types(parameters)
        for each in parameters:
            _check_name(node, each.name)
        changes = [each for each in map(_convert, parameters) if not _is_kept(node, each)]
        for each in changes:
            _check_change(node, each)
    except RefusedError as refusal:
        return SetParametersResult(successful=False, reason=str(refusal))
    if not changes:
        return SetParametersResult(successful=True)
    response = handler(service.Request(parameters=changes), service.Response())
    return response.results[0] if service is SetParameters else response.result


def _convert(message: ParameterMessage) -> ParameterMessage:
    """Return a parameter with a valid value of its type."""
    if message.name not in PARAMETERS:
        return message
    validate = PARAMETERS[message.name].validate
    clean = validate(message.name, parameter_value_to_python(message.value))
    return _typed(message.name, clean).to_parameter_msg()


def _check_name(node: Node, name: str) -> None:
    """Refuse a parameter that is not declared."""
    if not node.has_parameter(name):
        raise _refuse_name(name, _list_qos(node) if name.startswith(QOS) else KNOWN)


def _check_change(node: Node, message: ParameterMessage) -> None:
    """Refuse to change a parameter after the start, or its type; see `_convert` for our own."""
    name, value = message.name, message.value
    descriptor = node.describe_parameter(name)
    if descriptor.read_only:
        kept = node.get_parameter(name).value
        condition = f"{show(kept)} (read-only after the start of the node)"
        raise refuse(name, condition, parameter_value_to_python(value))
    if not descriptor.dynamic_typing and value.type != descriptor.type:
        kind = Parameter.Type(descriptor.type).name.lower().replace("_", " ")
        raise refuse(name, f"of type {kind}", parameter_value_to_python(value))


def _is_kept(node: Node, message: ParameterMessage) -> bool:
    """Return True for the value that a read-only parameter has: a dumped file sets all of them."""
    name = message.name
    is_fixed = node.has_parameter(name) and node.describe_parameter(name).read_only
    return is_fixed and node.get_parameter(name).get_parameter_value() == message.value


def fill_response(response: Any, granted: bool, answer: str) -> Any:
    """Write success and answer into the response of any of the service types."""
    if isinstance(response, SetParametersAtomically.Response):
        response.result = SetParametersResult(successful=granted, reason=answer)
    else:
        response.success, response.message = granted, answer
    return response


def read_values(parameters: Sequence[ParameterMessage]) -> dict[str, Any]:
    """Return the values of a request by name."""
    refuse_too_many(parameters)
    refuse_unknown_types(parameters)
    values: dict[str, Any] = {}
    for parameter in parameters:
        name = parameter.name
        value = _read_value(parameter)
        if name in values:
            raise RefusedError(f"{show(name)} must be given once, got it more than once")
        if value is None:
            raise refuse(f"type of {show(name)}", "1 to 9 (3 for a double)", 0)
        values[name] = value
    return values


def _read_value(parameter: ParameterMessage) -> Any:
    """Return the value of a parameter; without a type, the one field that is set.

    `ros2 service call ... {name: theta, value: {double_value: 0.5}}` sends no type. With 0.0 it
    sends no value either.
    """
    message = parameter.value
    if message.type != ParameterType.PARAMETER_NOT_SET:
        return parameter_value_to_python(message)
    given = _list_given(message)
    if not given and parameter.name not in NOT_NUMBERS:
        return 0.0
    return given[0] if len(given) == 1 else None


def _list_given(message: ParameterValue) -> list[Any]:
    """Return the fields of a value that are neither zero nor empty."""
    return [value for name in VALUE_FIELDS if (value := getattr(message, name))]


def tell_zeros(parameters: Sequence[ParameterMessage]) -> str:
    """Return which numbers of a granted request were read as 0, because nothing came; or ""."""
    zeros = [
        f"{each.name}: 0"
        for each in parameters
        if each.value.type == ParameterType.PARAMETER_NOT_SET and not _list_given(each.value)
    ]
    return f"{', '.join(zeros)} (a value without a type). " if zeros else ""


def refuse_too_many(parameters: Sequence[ParameterMessage]) -> None:
    """Refuse a request so long that reading it would delay samples."""
    if len(parameters) > MAX_COUNT:
        raise RefusedError(
            f"a request must have at most {MAX_COUNT} parameters, got {len(parameters)}"
        )


def refuse_unknown_types(parameters: Iterable[ParameterMessage]) -> None:
    """Refuse values of a parameter type that ROS does not have."""
    last = ParameterType.PARAMETER_STRING_ARRAY
    for parameter in parameters:
        if parameter.value.type > last:
            raise refuse(f"type of {show(parameter.name)}", f"0 to {last}", parameter.value.type)
