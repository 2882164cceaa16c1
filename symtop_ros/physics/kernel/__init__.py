"""The kernel: the one place where the physics is computed, in C++, and the door to it from Python.

`symtop.h` has its functions, for programs in other languages as well; `door.py` calls them.
"""
