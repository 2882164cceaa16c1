"""Topics and services of nodes: allowed by the SROS2 policy, and used in the graph."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from xml.etree import ElementTree

from rclpy.node import Node

POLICY = Path(__file__).parents[2] / "config" / "sros2_policy.xml"
RIGHTS = (
    ("topics", "publish"),
    ("topics", "subscribe"),
    ("services", "reply"),
    ("services", "request"),
)


@dataclass(frozen=True)
class Uses:
    """Full names of topics and services."""

    publish: frozenset[str] = frozenset()
    subscribe: frozenset[str] = frozenset()
    reply: frozenset[str] = frozenset()
    request: frozenset[str] = frozenset()

    def __or__(self, other: Uses) -> Uses:
        return Uses(*(getattr(self, f.name) | getattr(other, f.name) for f in fields(self)))


def allowed() -> dict[str, Uses]:
    """Topics and services that the policy allows, by enclave."""
    enclaves = ElementTree.parse(POLICY).getroot().iterfind("enclaves/enclave")
    return {each.attrib["path"]: _allowed(each) for each in enclaves}


def used(node: Node, name: str, as_name: str | None = None) -> Uses:
    """Topics and services that the graph shows for the node `name`.

    Names in its private namespace are returned for the node name `as_name`.
    """
    looks = (
        node.get_publisher_names_and_types_by_node,
        node.get_subscriber_names_and_types_by_node,
        node.get_service_names_and_types_by_node,
        node.get_client_names_and_types_by_node,
    )
    own = f"/{name}/"
    return Uses(
        *(
            frozenset(each.replace(own, f"/{as_name or name}/") for each, _ in look(name, "/"))
            for look in looks
        )
    )


def _allowed(enclave: ElementTree.Element) -> Uses:
    names: dict[str, set[str]] = {right: set() for _, right in RIGHTS}
    for profile in enclave.iterfind("profiles/profile"):
        for kind, right in RIGHTS:
            for entry in profile.iterfind(f"{kind}[@{right}='ALLOW']/*"):
                names[right].add(_full(entry.text or "", profile))
    return Uses(**{right: frozenset(each) for right, each in names.items()})


def _full(name: str, profile: ElementTree.Element) -> str:
    return name.replace("~", f"{profile.attrib['ns']}{profile.attrib['node']}")
