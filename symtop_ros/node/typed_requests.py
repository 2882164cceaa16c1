"""Requests with parameters of a type that ROS does not have: rclpy itself would end the node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically

from symtop_ros.node.fields import RefusedError, check_types

Handle = Callable[[Any, Any], Any]


def with_known_types(kind: Any, handle: Handle) -> Handle:
    """Return what answers requests to a service of a kind: such ones with a refusal."""
    refused = REFUSED.get(kind)
    if not refused:
        return handle

    def answer(request: Any, response: Any) -> Any:
        try:
            check_types(request.parameters)
        except RefusedError as refusal:
            result = SetParametersResult(successful=False, reason=str(refusal))
            return refused(result, len(request.parameters))
        return handle(request, response)

    return answer


def _each(result: SetParametersResult, count: int) -> Any:
    return SetParameters.Response(results=[result] * count)


def _together(result: SetParametersResult, _: int) -> Any:
    return SetParametersAtomically.Response(result=result)


REFUSED: dict[Any, Callable[[SetParametersResult, int], Any]] = {
    SetParameters: _each,
    SetParametersAtomically: _together,
}
