// The kernel as a module of Python, symtop_ros.physics.kernel._kernel, with the stable interface of
// Python 3.11: one build serves all later versions. Arrays are C-contiguous buffers of doubles.
#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030b0000
#include <Python.h>

#include <new>

#include "blocks.hpp"
#include "driven/trail.hpp"

using namespace symtop;

namespace {

// A buffer of an argument, released at the end of its scope.
class Buffer {
 public:
  Buffer(PyObject* object, bool is_written) {
    is_valid_ = PyObject_GetBuffer(object, &view_, is_written ? PyBUF_WRITABLE : PyBUF_SIMPLE) == 0;
  }
  ~Buffer() {
    if (is_valid_) PyBuffer_Release(&view_);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  // The numbers if there are `count` of them, else null with an exception set.
  template <class T>
  T* get(Py_ssize_t count) const {
    if (!is_valid_) return nullptr;
    if (view_.len == count * static_cast<Py_ssize_t>(sizeof(T))) return static_cast<T*>(view_.buf);
    PyErr_SetString(PyExc_ValueError, "array of another size");
    return nullptr;
  }
  Py_ssize_t bytes() const { return is_valid_ ? view_.len : -1; }

 private:
  Py_buffer view_;
  bool is_valid_;
};

template <class T>
struct Holder {  // an object of Python that holds one of ours
  PyObject_HEAD
  T* held;
};

template <class T>
T& held(PyObject* self) {
  return *reinterpret_cast<Holder<T>*>(self)->held;
}

template <class T>
void dealloc(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  delete reinterpret_cast<Holder<T>*>(self)->held;
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

template <class T>
PyObject* allocate(PyTypeObject* type) {
  PyObject* self = reinterpret_cast<allocfunc>(PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (!self) return nullptr;
  T* object = new (std::nothrow) T();
  reinterpret_cast<Holder<T>*>(self)->held = object;
  if (object) return self;
  Py_DECREF(self);
  return PyErr_NoMemory();
}

Start read_start(const double* s) {
  return {s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], s[8], s[9]};
}

// ---- ClosedForm ---------------------------------------------------------------------------------

PyObject* new_closed_form(PyTypeObject* type, PyObject* arguments, PyObject*) {
  double s[10];
  int is_turned_over;
  if (!PyArg_ParseTuple(arguments, "(ddd)(dddd)(ddd)p", s, s + 1, s + 2, s + 3, s + 4, s + 5, s + 6,
                        s + 7, s + 8, s + 9, &is_turned_over))
    return nullptr;
  if (!can_solve(read_start(s))) {
    PyErr_SetString(PyExc_ValueError, "start must be finite, with Mgl > 0 and an axis that moves");
    return nullptr;
  }
  PyObject* self = allocate<ClosedForm>(type);
  if (self) held<ClosedForm>(self).prepare(read_start(s), is_turned_over);
  return self;
}

// at(t): w, x, y, z, omega_x, omega_y, or None if the time is too far
PyObject* closed_form_at(PyObject* self, PyObject* time) {
  const double t = PyFloat_AsDouble(time);
  if (PyErr_Occurred()) return nullptr;
  ClosedForm& motion = held<ClosedForm>(self);
  if (motion.is_far(t)) Py_RETURN_NONE;
  const Attitude s = motion.at(t);
  return Py_BuildValue("(dddddd)", s.w, s.x, s.y, s.z, s.omega_x, s.omega_y);
}

// fill(times, orientation, omega, far): far[i] is set to 1 if time i is too far; no state is written
// for it
PyObject* closed_form_fill(PyObject* self, PyObject* arguments) {
  PyObject *times, *orientation, *omega, *far;
  if (!PyArg_ParseTuple(arguments, "OOOO", &times, &orientation, &omega, &far)) return nullptr;
  Buffer t(times, false), q(orientation, true), rates(omega, true), f(far, true);
  const Py_ssize_t count = t.bytes() / static_cast<Py_ssize_t>(sizeof(double));
  const double* from = t.get<double>(count);
  double *to = q.get<double>(4 * count), *to_rates = rates.get<double>(3 * count);
  uint8_t* is_far = f.get<uint8_t>(count);
  if (PyErr_Occurred()) return nullptr;
  ClosedForm& motion = held<ClosedForm>(self);
  motion.prepare_first_instants();  // now, because threads may share the motion
  Py_BEGIN_ALLOW_THREADS
  fill(motion, from, count, {to, to_rates}, is_far);
  Py_END_ALLOW_THREADS
  Py_RETURN_NONE;
}

// fill_phases(seconds, places, turns, orientation, omega): states at phases that Python has
// computed from exact times; turns are (4, n): see blocks.hpp.
PyObject* closed_form_fill_phases(PyObject* self, PyObject* arguments) {
  PyObject *seconds, *places, *turns, *orientation, *omega;
  if (!PyArg_ParseTuple(arguments, "OOOOO", &seconds, &places, &turns, &orientation, &omega))
    return nullptr;
  Buffer t(seconds, false), p(places, false), n(turns, false), q(orientation, true),
      rates(omega, true);
  const Py_ssize_t count = p.bytes();
  const double* from = t.get<double>(count);
  const uint8_t* place = p.get<uint8_t>(count);
  const uint64_t* phase = n.get<uint64_t>(4 * count);
  double *to = q.get<double>(4 * count), *to_rates = rates.get<double>(3 * count);
  if (PyErr_Occurred()) return nullptr;
  ClosedForm& motion = held<ClosedForm>(self);
  motion.prepare_first_instants();
  fill_phases(motion, from, place, phase, count, {to, to_rates});
  Py_RETURN_NONE;
}

PyObject* describe(const Steps& steps, int count) {
  return Py_BuildValue("(iy#)", steps.exponent, reinterpret_cast<const char*>(steps.limbs),
                       static_cast<Py_ssize_t>(count * sizeof steps.limbs[0]));
}

// steps(): exponent and steps of the three phases, and those of the first instants
PyObject* closed_form_steps(PyObject* self, PyObject*) {
  ClosedForm& motion = held<ClosedForm>(self);
  motion.prepare_first_instants();
  return Py_BuildValue("(dNN)", motion.first_end, describe(motion.steps, FUNCTIONS),
                       describe(motion.first_instants.half_turn, 1));
}

PyMethodDef CLOSED_FORM_METHODS[] = {
    {"at", closed_form_at, METH_O, nullptr},
    {"fill", closed_form_fill, METH_VARARGS, nullptr},
    {"fill_phases", closed_form_fill_phases, METH_VARARGS, nullptr},
    {"steps", closed_form_steps, METH_NOARGS, nullptr},
    {nullptr, nullptr, 0, nullptr},
};

PyType_Slot CLOSED_FORM_SLOTS[] = {
    {Py_tp_new, reinterpret_cast<void*>(new_closed_form)},
    {Py_tp_dealloc, reinterpret_cast<void*>(dealloc<ClosedForm>)},
    {Py_tp_methods, CLOSED_FORM_METHODS},
    {0, nullptr},
};

PyType_Spec CLOSED_FORM = {"symtop_ros.physics.kernel._kernel.ClosedForm",
                           sizeof(Holder<ClosedForm>), 0, Py_TPFLAGS_DEFAULT, CLOSED_FORM_SLOTS};

// ---- Trail --------------------------------------------------------------------------------------

PyObject* new_trail(PyTypeObject* type, PyObject* arguments, PyObject*) {
  DrivenArguments a;
  double *f = a.torque, *q = a.orientation, *w = a.omega;
  int direction;
  if (!PyArg_ParseTuple(arguments, "(ddd)(dd)(ddd)(dddd)(ddd)i", &a.Ix, &a.Iz, &a.Mgl, &a.axial,
                        &a.transverse, f, f + 1, f + 2, q, q + 1, q + 2, q + 3, w, w + 1, w + 2,
                        &direction))
    return nullptr;
  PyObject* self = allocate<Trail>(type);
  if (!self || held<Trail>(self).prepare(a, direction)) return self;
  Py_DECREF(self);
  return PyErr_NoMemory();
}

// reach(t, steps): the time reached, and True if the motion is too fast to go on
PyObject* trail_reach(PyObject* self, PyObject* arguments) {
  double t, steps;
  if (!PyArg_ParseTuple(arguments, "dd", &t, &steps)) return nullptr;
  Trail& trail = held<Trail>(self);
  bool is_stuck = false;
  double reached = 0.0;
  Py_BEGIN_ALLOW_THREADS
  reached = trail.reach(t, &steps, &is_stuck);
  Py_END_ALLOW_THREADS
  return Py_BuildValue("(dN)", reached, PyBool_FromLong(is_stuck));
}

// fill(times, rests, orientation, omega, steps): the number of states written, from the first on, and
// True if the motion is too fast to go on. Less than all are written then, or after so many steps.
// Times are sums of two doubles, sorted from the start on.
PyObject* trail_fill(PyObject* self, PyObject* arguments) {
  PyObject *times, *rests, *orientation, *omega;
  double steps;
  if (!PyArg_ParseTuple(arguments, "OOOOd", &times, &rests, &orientation, &omega, &steps))
    return nullptr;
  Buffer t(times, false), r(rests, false), q(orientation, true), rates(omega, true);
  const Py_ssize_t count = t.bytes() / static_cast<Py_ssize_t>(sizeof(double));
  const double *from = t.get<double>(count), *rest = r.get<double>(count);
  double *to = q.get<double>(4 * count), *to_rates = rates.get<double>(3 * count);
  if (PyErr_Occurred()) return nullptr;
  Trail& trail = held<Trail>(self);
  Py_ssize_t written = 0;
  bool is_stuck = false;
  Py_BEGIN_ALLOW_THREADS
  for (; written < count; written++) {
    const double t = from[written];
    if (trail.reach(t, &steps, &is_stuck) != t) break;
    trail.read(t, rest[written], to + 4 * written, to_rates + 3 * written);
  }
  Py_END_ALLOW_THREADS
  return Py_BuildValue("(nN)", written, PyBool_FromLong(is_stuck));
}

PyMethodDef TRAIL_METHODS[] = {
    {"reach", trail_reach, METH_VARARGS, nullptr},
    {"fill", trail_fill, METH_VARARGS, nullptr},
    {nullptr, nullptr, 0, nullptr},
};

PyType_Slot TRAIL_SLOTS[] = {
    {Py_tp_new, reinterpret_cast<void*>(new_trail)},
    {Py_tp_dealloc, reinterpret_cast<void*>(dealloc<Trail>)},
    {Py_tp_methods, TRAIL_METHODS},
    {0, nullptr},
};

PyType_Spec TRAIL = {"symtop_ros.physics.kernel._kernel.Trail", sizeof(Holder<Trail>), 0,
                     Py_TPFLAGS_DEFAULT, TRAIL_SLOTS};

// ---- Many motions -------------------------------------------------------------------------------

// fill_many(starts, turned_over, times, orientation, omega, far): n motions at the same m times, with
// 10 numbers for a start; far[i][j] is set to 1 if time j is too far for motion i. A motion without a
// closed form is not computed: all of its times are far.
PyObject* fill_many(PyObject*, PyObject* arguments) {
  PyObject *starts, *turned_over, *times, *orientation, *omega, *far;
  if (!PyArg_ParseTuple(arguments, "OOOOOO", &starts, &turned_over, &times, &orientation, &omega,
                        &far))
    return nullptr;
  Buffer s(starts, false), o(turned_over, false), t(times, false), q(orientation, true),
      rates(omega, true), f(far, true);
  const Py_ssize_t count = o.bytes(), each = t.bytes() / static_cast<Py_ssize_t>(sizeof(double));
  const double *start = s.get<double>(10 * count), *from = t.get<double>(each);
  const uint8_t* over = o.get<uint8_t>(count);
  double *to = q.get<double>(4 * count * each), *to_rates = rates.get<double>(3 * count * each);
  uint8_t* is_far = f.get<uint8_t>(count * each);
  if (PyErr_Occurred()) return nullptr;
  Py_BEGIN_ALLOW_THREADS
  ClosedForm motion;
  for (Py_ssize_t i = 0; i < count; i++) {
    const Start given = read_start(start + 10 * i);
    if (!can_solve(given)) {
      std::memset(is_far + i * each, 1, each);
      continue;
    }
    motion.has_first_instants = false;
    motion.prepare(given, over[i]);
    fill(motion, from, each, {to + 4 * i * each, to_rates + 3 * i * each}, is_far + i * each);
  }
  Py_END_ALLOW_THREADS
  Py_RETURN_NONE;
}

// set_rows(rows): the table of cosines and sines of phases.py
PyObject* set_rows(PyObject*, PyObject* rows) {
  Buffer buffer(rows, false);
  const double* from = buffer.get<double>(4 * ENTRIES);
  if (!from) return nullptr;
  std::memcpy(ROWS, from, sizeof ROWS);
  Py_RETURN_NONE;
}

PyMethodDef METHODS[] = {
    {"fill_many", fill_many, METH_VARARGS, nullptr},
    {"set_rows", set_rows, METH_O, nullptr},
    {nullptr, nullptr, 0, nullptr},
};

int add_type(PyObject* module, PyType_Spec& spec, const char* name) {
  PyObject* type = PyType_FromSpec(&spec);
  if (!type) return -1;
  const int result = PyModule_AddObjectRef(module, name, type);
  Py_DECREF(type);
  return result;
}

int execute(PyObject* module) {
  if (add_type(module, CLOSED_FORM, "ClosedForm") < 0) return -1;
  return add_type(module, TRAIL, "Trail");
}

PyModuleDef_Slot SLOTS[] = {{Py_mod_exec, reinterpret_cast<void*>(execute)}, {0, nullptr}};

PyModuleDef MODULE = {PyModuleDef_HEAD_INIT, "_kernel", nullptr, 0, METHODS, SLOTS,
                      nullptr, nullptr, nullptr};

}  // namespace

PyMODINIT_FUNC PyInit__kernel() { return PyModuleDef_Init(&MODULE); }
