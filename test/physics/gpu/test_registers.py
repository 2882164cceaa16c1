"""The check of machine code finds a uniform register that is spoiled, and nothing in sound code."""

from physics.gpu.registers import find_suspects

# One arm reads the base of the stack from UR4, into which the other has put a constant.
CODE = """
\t\tFunction : {name}
        /*0000*/                   S2UR UR4, SR_CTAID.X ;
        /*0010*/                   ISETP.NE.AND P0, PT, R2, RZ, PT ;
        /*0020*/               @P0 BRA 0x60 ;
        /*0030*/                   {first} ;
        /*0040*/                   DADD R6, R8, R10 ;
        /*0050*/                   BRA 0x70 ;
        /*0060*/                   IADD3 R1, R1, UR4, RZ ;
        /*0070*/                   EXIT ;
"""
CALL = """
\t\tFunction : calling
        /*0000*/                   UMOV UR6, 0x10 ;
        /*0010*/               @P0 BRA 0x40 ;
        /*0020*/                   CALL.REL.NOINC 0x60 ;
        /*0030*/                   BRA 0x50 ;
        /*0040*/                   IADD3 R1, R1, UR6, RZ ;
        /*0050*/                   EXIT ;
        /*0060*/                   ULDC.64 UR6, c[0x0][0x208] ;
        /*0070*/                   RET.REL.NODEC R20 0x0 ;
"""


def test_a_register_that_the_other_arm_overwrites_is_a_suspect():
    spoiled = CODE.format(name="spoiled", first="UMOV UR4, 0x55555555")
    assert find_suspects(spoiled) == {"spoiled": ["UR4 in IADD3 R1, R1, UR4, RZ"]}


def test_another_register_is_none():
    sound = CODE.format(name="sound", first="UMOV UR5, 0x55555555")
    assert find_suspects(sound) == {"sound": []}


def test_a_call_counts_as_what_its_callee_writes():
    assert find_suspects(CALL) == {"calling": ["UR6 in IADD3 R1, R1, UR6, RZ"]}
