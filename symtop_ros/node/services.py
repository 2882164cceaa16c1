"""Translation between ROS services and the requests of a simulation."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import parameter_value_to_python
from std_srvs.srv import SetBool, Trigger

from symtop_ros.session.services import ServiceKind
from symtop_ros.simulation.validation import RefusedError, reject, show

MAX_COUNT = 1000  # parameters of a request; a file with all of them has a tenth
VALUE_FIELDS = (
    *("bool_value", "integer_value", "double_value", "string_value"),
    *("bool_array_value", "integer_array_value", "double_array_value", "string_array_value"),
)
# By the kind of a service: its ROS type, and how the argument of the request is read.
TYPES: dict[ServiceKind, tuple[type, Callable[[Any], Any]]] = {
    "named": (SetParametersAtomically, lambda request: read_values(request.parameters)),
    "switch": (SetBool, lambda request: bool(request.data)),
    "plain": (Trigger, lambda _: None),
}


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
        name, value = parameter.name, _read_value(parameter.value)
        if name in values:
            raise RefusedError(f"{show(name)} must be given once, got it more than once")
        if value is None:
            raise reject(f"type of {show(name)}", "1 to 9 (3 for a double)", 0)
        values[name] = value
    return values


def _read_value(message: ParameterValue) -> Any:
    """Return the value of a message; without a type, the one field that is set.

    `ros2 service call ... {name: theta, value: {double_value: 0.5}}` sends no type.
    """
    if message.type != ParameterType.PARAMETER_NOT_SET:
        return parameter_value_to_python(message)
    given = [value for name in VALUE_FIELDS if (value := getattr(message, name))]
    return given[0] if len(given) == 1 else None


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
            raise reject(f"type of {show(parameter.name)}", f"0 to {last}", parameter.value.type)
