"""Names of nodes as ROS has them."""


def full_name(node: str) -> str:
    """Return the full name of a node; the slash at its beginning may be left out."""
    return f"/{node.strip('/')}"
