"""Uniform registers that another arm of a branch may have overwritten, in machine code of a GPU.

A warp shares its uniform registers. Where its threads part at a branch, it runs one arm after the
other; a value that is kept in such a register for both arms must not be overwritten in the first.
ptxas 13.0 and 13.5 did so in a function that had free motions and others: the second arm then read
a constant in place of the base of the stack. A use is suspect if, in the order of the code, another
definition of its register lies between it and the definition that reaches it: that one belongs to
another arm, and a warp that takes both runs it in between. A call counts as what its callee writes.
"""

import re
from bisect import bisect_left, bisect_right
from collections import defaultdict
from dataclasses import dataclass, field

LINE = re.compile(r"\s+/\*([0-9a-f]{4,6})\*/\s+(.*?)\s*;")
FUNCTION = re.compile(r"\s*Function : (\S+)")
GUARD = re.compile(r"^@!?U?P\w+\s+")
UNIFORM = re.compile(r"UR(\d+)")
ADDRESS = re.compile(r"0x[0-9a-f]+")
# Instructions that write the uniform register they name first.
WRITERS = ("UMOV", "ULDC", "R2UR", "UI", "UL", "US", "UF", "UP", "S2UR", "UBMSK", "UBREV", "REDUX")
WRITERS = (*WRITERS, "VOTEU", "LDCU")
COUNT = 64  # uniform registers

Definitions = dict[int, set[int]]  # of each register, where it may have been written


@dataclass
class Instruction:
    """Effect of an instruction on uniform registers, and the instructions that may follow."""

    text: str
    name: str
    is_guarded: bool
    target: int | None  # an address
    writes: set[int] = field(default_factory=set)
    reads: set[int] = field(default_factory=set)

    @property
    def ends(self) -> bool:
        """Return True if the next instruction is not reached from it."""
        return self.name.startswith(("RET", "EXIT", "BRA")) and not self.is_guarded


def read_instruction(text: str) -> Instruction:
    """Read a line of machine code."""
    bare = GUARD.sub("", text)
    name, _, rest = bare.partition(" ")
    parts = [part.strip() for part in rest.split(",")]
    addresses = ADDRESS.findall(bare)
    found = Instruction(text, name, bare != text, int(addresses[0], 16) if addresses else None)
    first = re.fullmatch(r"UR(\d+)", parts[0].split(".")[0])
    if first and name.startswith(WRITERS):
        number = int(first[1])
        is_pair = ".64" in name or ".WIDE" in name
        found.writes = {number, number + 1} if is_pair else {number}
        parts = parts[1:]
    for register in (int(each) for part in parts for each in UNIFORM.findall(part)):
        # a double is in two
        found.reads |= {register, register + 1} if name.startswith("D") else {register}
    return found


def read_functions(sass: str) -> dict[str, dict[int, Instruction]]:
    """Return the instructions of each function of `cuobjdump -sass`, by their addresses."""
    functions: dict[str, dict[int, Instruction]] = {}
    for line in sass.splitlines():
        if head := FUNCTION.match(line):
            code = functions[head[1]] = {}
        elif found := LINE.match(line):
            code[int(found[1], 16)] = read_instruction(found[2])
    return functions


class Flow:
    """The definitions of uniform registers that reach each instruction of a function."""

    def __init__(self, code: dict[int, Instruction]) -> None:
        places = {address: k for k, address in enumerate(code)}
        self.code = [*code.values()]
        self.targets = [places.get(each.target) if each.target else None for each in self.code]
        self._written: dict[int, set[int]] = {}
        # what each instruction writes, calls included
        self.writes = [
            each.writes | self._find_written_by_call(k) for k, each in enumerate(self.code)
        ]
        self.reaching: list[Definitions | None] = [None] * len(self.code)
        self._spread()

    def _find_written_by_call(self, place: int) -> set[int]:
        target = self.targets[place]
        is_call = self.code[place].name.startswith("CALL") and target is not None
        return self._find_written(target) if is_call and target is not None else set()

    def _find_written(self, start: int) -> set[int]:
        """Return the registers that a callee writes, or those that it calls."""
        if start not in self._written:
            self._written[start] = set()  # of a function that calls itself
            seen = set()
            waiting = [start]
            written = set()
            while waiting:
                place = waiting.pop()
                if place in seen or place >= len(self.code):
                    continue
                seen.add(place)
                written |= self.code[place].writes | self._find_written_by_call(place)
                waiting += self._list_next(place)
            self._written[start] = written
        return self._written[start]

    def _list_next(self, place: int) -> list[int]:
        each, target = self.code[place], self.targets[place]
        jump = [target] if each.name == "BRA" and target is not None else []
        return jump + ([] if each.ends else [place + 1])

    def _spread(self) -> None:
        calls = [k for k, each in enumerate(self.code) if each.name.startswith("CALL")]
        roots = {0, *(self.targets[k] for k in calls)} - {None}
        waiting = [root for root in roots if root is not None]
        for root in waiting:  # what a caller has written counts as written at the entry
            self.reaching[root] = {register: {root} for register in range(COUNT)}
        while waiting:
            place = waiting.pop()
            after = {r: set(d) for r, d in (self.reaching[place] or {}).items()}
            for register in self.writes[place]:
                kept = after.get(register, set()) if self.code[place].is_guarded else set()
                after[register] = {place} | kept
            waiting += [each for each in self._list_next(place) if self._merge(each, after)]

    def _merge(self, place: int, given: Definitions) -> bool:
        """Add definitions that reach an instruction; return True if any is new."""
        if place >= len(self.code):
            return False
        if self.reaching[place] is None:
            self.reaching[place] = {r: set(d) for r, d in given.items()}
            return True
        here = self.reaching[place] or {}
        is_new = False
        for register, definitions in given.items():
            if not definitions <= here.setdefault(register, set()):
                here[register] |= definitions
                is_new = True
        return is_new

    def find_suspects(self) -> list[str]:
        """Return the uses of a register that another arm may have overwritten."""
        defined: dict[int, list[int]] = defaultdict(list)
        for place, registers in enumerate(self.writes):
            for register in registers if self.reaching[place] is not None else ():
                defined[register].append(place)
        suspects = []
        for place, each in enumerate(self.code):
            for register in sorted(each.reads):
                reaching = (self.reaching[place] or {}).get(register, set())
                before = max((d for d in reaching if d < place), default=None)
                if before is None:
                    continue
                all_of = defined[register]
                between = all_of[bisect_right(all_of, before) : bisect_left(all_of, place)]
                if {*between} - reaching:
                    suspects.append(f"UR{register} in {each.text}")
        return suspects


def find_suspects(sass: str) -> dict[str, list[str]]:
    """Return the suspect uses of each function, by its name."""
    return {name: Flow(code).find_suspects() for name, code in read_functions(sass).items()}
