"""Requests that are made to hurt: large, long, deep or many; each is built when it is sent."""

from __future__ import annotations

import importlib
from array import array
from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from std_srvs.srv import SetBool, Trigger

MILLION, MANY = 1_000_000, 100_000
Build = Callable[[], tuple[Any, str, Any]]  # type, name and request


def value(**field: Any) -> ParameterValue:
    """A value of the type of its field."""
    ((name, _),) = field.items()
    kind = getattr(ParameterType, f"PARAMETER_{name.removesuffix('_value').upper()}")
    return ParameterValue(type=kind, **field)


# Values of parameters, by what is hard about them; the name is that of a real one.
VALUES: dict[str, Callable[[], ParameterValue]] = {
    "doubles": lambda: value(double_array_value=array("d", [0.5]) * MILLION),
    "integers": lambda: value(integer_array_value=array("q", [7]) * MILLION),
    "bools": lambda: value(bool_array_value=[True] * MILLION),
    "texts": lambda: value(string_array_value=["a"] * MANY),
    "long text": lambda: value(string_value="a" * 10 * MILLION),
    "deep text": lambda: value(string_value="[" * 10 * MILLION),
    "list as text": lambda: value(string_value=f"[{'1,' * 5 * MILLION}1]"),
    "digits": lambda: value(string_value="[" + "9" * 10 * MILLION + "]"),
    "bytes": lambda: ParameterValue(type=5, byte_array_value=[b"\1"] * MANY),
}
NAMED = {
    "kick": "angular_impulse",
    "set_initial_conditions": "orientation",
    "step": "duration",
    "set_parameters": "initial.orientation",
    "set_parameters_atomically": "steady_torque",
}
# More parameters than there are, by the way in which their names differ.
CROWDS: dict[str, Callable[[str], list[Parameter]]] = {
    "the same name": lambda name: [Parameter(name=name, value=value(double_value=0.5))] * MANY,
    "other names": lambda name: [
        Parameter(name=f"{name}.{k}", value=value(double_value=0.5)) for k in range(MANY)
    ],
}
FILTERS = {
    "backtracking": ".?" * 900 + "z",
    "a short one": ".?" * 60 + "z",
    "nested stars": "((a*)*)*" * 100 + "z",
    "groups": "(" * 5000 + ")" * 5000,
    "counted": "((((.{255}){255}){255}){255}){255}",
    "choices": "(top|" * 90 + "t" + ")" * 90,
    "long": "t" * MILLION,
    "classes": "[[:alpha:]]" * 900,
}


def list_requests() -> dict[str, Build]:
    """Return all requests by their names."""
    return {**_list_named(), **_list_of_names(), **_list_standard(), **_list_plain()}


def _list_named() -> dict[str, Build]:
    def ask(service: str, parameters: Any) -> tuple[Any, str, Any]:
        kind = SetParameters if service == "set_parameters" else SetParametersAtomically
        return kind, service, kind.Request(parameters=parameters)

    found: dict[str, Build] = {}
    for service, name in NAMED.items():
        for hard, build in VALUES.items():
            found[f"{service}, {hard}"] = lambda service=service, name=name, build=build: ask(
                service, [Parameter(name=name, value=build())]
            )
        for hard, crowd in CROWDS.items():
            found[f"{service}, {hard}"] = lambda service=service, name=name, crowd=crowd: ask(
                service, crowd(name)
            )
    return found


def _list_of_names() -> dict[str, Build]:
    names = [f"top.{k}" for k in range(MANY)]
    kinds = (GetParameters, GetParameterTypes, DescribeParameters)
    services = ("get_parameters", "get_parameter_types", "describe_parameters")
    found: dict[str, Build] = {
        service: lambda kind=kind, service=service: (kind, service, kind.Request(names=names))
        for kind, service in zip(kinds, services, strict=True)
    }
    few = ListParameters.Request(prefixes=names[:1000])
    return {**found, "list_parameters": lambda: (ListParameters, "list_parameters", few)}


def _list_standard() -> dict[str, Build]:
    def build(package: str, name: str) -> Any:
        return getattr(importlib.import_module(f"simulation_interfaces.{package}"), name)

    def filter_by(**fields: Any) -> tuple[Any, str, Any]:
        kind, filters = build("srv", "GetEntities"), build("msg", "EntityFilters")(**fields)
        return kind, "get_entities", kind.Request(filters=filters)

    def set_state() -> tuple[Any, str, Any]:
        kind = build("srv", "SetEntityState")
        request = kind.Request(entity="top", set_pose=True)
        request.state.header.frame_id = "w" * 10 * MILLION
        return kind, "set_entity_state", request

    def get_state() -> tuple[Any, str, Any]:
        kind = build("srv", "GetEntityState")
        return kind, "get_entity_state", kind.Request(entity="t" * 10 * MILLION)

    return {
        **{
            f"filter, {name}": lambda pattern=pattern: filter_by(filter=pattern)
            for name, pattern in FILTERS.items()
        },
        "filter, tags": lambda: filter_by(tags=build("msg", "TagsFilter")(tags=["a"] * MANY)),
        "filter, categories": lambda: filter_by(
            categories=[build("msg", "EntityCategory")()] * MANY
        ),
        "entity of a long name": get_state,
        "frame of a long name": set_state,
    }


def _list_plain() -> dict[str, Build]:
    return {
        "begin to record": lambda: (SetBool, "record", SetBool.Request(data=True)),
        "end to record": lambda: (SetBool, "record", SetBool.Request(data=False)),
        "state": lambda: (Trigger, "get_state", Trigger.Request()),
    }
