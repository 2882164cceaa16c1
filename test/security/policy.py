"""Topics and services of nodes: allowed by the SROS2 policy, and used in the graph."""

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from rclpy.node import Node

POLICY = Path(__file__).parents[2] / "config" / "sros2_policy.xml"
RIGHTS = {"publish": "topics", "subscribe": "topics", "reply": "services", "request": "services"}
KINDS = {"publish": "publisher", "subscribe": "subscriber", "reply": "service", "request": "client"}
Use = tuple[str, str]  # a right, and the full name of a topic or service


def allowed() -> dict[str, set[Use]]:
    """Topics and services that the policy allows, by enclave."""
    enclaves = ElementTree.parse(POLICY).getroot().iterfind("enclaves/enclave")
    return {each.attrib["path"]: {*_allowed(each)} for each in enclaves}


def used(node: Node, name: str, as_name: str | None = None) -> set[Use]:
    """Topics and services that the graph shows for the node `name`.

    Names in its private namespace are returned for the node name `as_name`.
    """
    looks = {right: getattr(node, f"get_{KINDS[right]}_names_and_types_by_node") for right in KINDS}
    names = [(right, each) for right, look in looks.items() for each, _ in look(name, "/")]
    return {(right, each.replace(f"/{name}/", f"/{as_name or name}/")) for right, each in names}


def _allowed(enclave: ElementTree.Element) -> Iterator[Use]:
    for profile in enclave.iterfind("profiles/profile"):
        own = f"{profile.attrib['ns']}{profile.attrib['node']}"
        for right, kind in RIGHTS.items():
            for entry in profile.iterfind(f"{kind}[@{right}='ALLOW']/*"):
                yield right, (entry.text or "").replace("~", own)
