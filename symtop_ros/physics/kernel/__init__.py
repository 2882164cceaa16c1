"""The kernel: the one place where the physics is computed, in C++, and what calls it from Python.

`symtop.h` has its functions, for programs in other languages as well; `bindings.py` calls them.
"""
