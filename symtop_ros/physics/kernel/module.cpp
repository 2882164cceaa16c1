// The functions of symtop.h as a module of Python, symtop_ros.physics.kernel._kernel, with the
// stable interface of Python 3.11: one build serves all later versions. Arrays are C-contiguous
// buffers.
#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030b0000
#include <Python.h>

#include <cmath>
#include <cstring>

#include "symtop.h"

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

const Py_ssize_t NUMBER = sizeof(double);
const int NUMBERS = sizeof(symtop_start) / sizeof(double);  // of a start

struct Holder {  // an object of Python that holds a motion
  PyObject_HEAD
  symtop_motion* motion;
};

symtop_motion* held(PyObject* self) { return reinterpret_cast<Holder*>(self)->motion; }

PyObject* raise(symtop_status status) {
  if (status == SYMTOP_NO_MEMORY) return PyErr_NoMemory();
  PyErr_SetString(PyExc_ValueError, symtop_describe_status(status));
  return nullptr;
}

// Motion((Ix, Iz, Mgl), orientation, angular velocity, (axial, transverse), torque)
PyObject* new_motion(PyTypeObject* type, PyObject* arguments, PyObject*) {
  symtop_start s;
  double *q = s.orientation, *w = s.angular_velocity, *f = s.friction, *t = s.torque;
  if (!PyArg_ParseTuple(arguments, "(ddd)(dddd)(ddd)(dd)(ddd)", &s.Ix, &s.Iz, &s.Mgl, q, q + 1,
                        q + 2, q + 3, w, w + 1, w + 2, f, f + 1, t, t + 1, t + 2))
    return nullptr;
  symtop_motion* motion;
  const symtop_status status = symtop_new(&s, &motion);
  if (status != SYMTOP_OK) return raise(status);
  PyObject* self = reinterpret_cast<allocfunc>(PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (self)
    reinterpret_cast<Holder*>(self)->motion = motion;
  else
    symtop_free(motion);
  return self;
}

void dealloc(PyObject* self) {
  PyTypeObject* type = Py_TYPE(self);
  symtop_free(held(self));
  reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
  Py_DECREF(type);
}

// at(t): the seven numbers of a state, or None if the time is too far
PyObject* motion_at(PyObject* self, PyObject* time) {
  const double t = PyFloat_AsDouble(time);
  if (PyErr_Occurred()) return nullptr;
  double q[4], omega[3];
  const symtop_status status = symtop_state(held(self), t, q, omega);
  if (status == SYMTOP_TOO_FAR) Py_RETURN_NONE;
  if (status != SYMTOP_OK) return raise(status);
  return Py_BuildValue("(ddddddd)", q[0], q[1], q[2], q[3], omega[0], omega[1], omega[2]);
}

PyObject* describe_progress(size_t written, symtop_status status) {
  return Py_BuildValue("(ni)", static_cast<Py_ssize_t>(written), static_cast<int>(status));
}

// fill(times, orientation, omega, most_steps): the number of states written, and the status
PyObject* motion_fill(PyObject* self, PyObject* arguments) {
  PyObject *times, *orientation, *omega;
  double steps;
  if (!PyArg_ParseTuple(arguments, "OOOd", &times, &orientation, &omega, &steps)) return nullptr;
  Buffer t(times, false), q(orientation, true), rates(omega, true);
  const Py_ssize_t count = t.bytes() / NUMBER;
  const double* from = t.get<double>(count);
  double *to = q.get<double>(4 * count), *to_rates = rates.get<double>(3 * count);
  if (PyErr_Occurred()) return nullptr;
  size_t written;
  symtop_status status;
  Py_BEGIN_ALLOW_THREADS
  status = symtop_states(held(self), from, static_cast<size_t>(count), steps, to, to_rates,
                         &written);
  Py_END_ALLOW_THREADS
  return describe_progress(written, status);
}

// fill_stamps(stamps, (factor, elapsed), orientation, omega, most_steps): the same, at exact times
PyObject* motion_fill_stamps(PyObject* self, PyObject* arguments) {
  PyObject *stamps, *orientation, *omega;
  symtop_clock clock;
  double steps, *elapsed = clock.elapsed;
  if (!PyArg_ParseTuple(arguments, "O(d(dddd))OOd", &stamps, &clock.factor, elapsed, elapsed + 1,
                        elapsed + 2, elapsed + 3, &orientation, &omega, &steps))
    return nullptr;
  Buffer t(stamps, false), q(orientation, true), rates(omega, true);
  const Py_ssize_t count = t.bytes() / static_cast<Py_ssize_t>(sizeof(int64_t));
  const int64_t* from = t.get<int64_t>(count);
  double *to = q.get<double>(4 * count), *to_rates = rates.get<double>(3 * count);
  if (PyErr_Occurred()) return nullptr;
  size_t written;
  symtop_status status;
  Py_BEGIN_ALLOW_THREADS
  status = symtop_states_of_clock(held(self), &clock, from, static_cast<size_t>(count), steps, to,
                                  to_rates, &written);
  Py_END_ALLOW_THREADS
  return describe_progress(written, status);
}

// reach(t, most_steps): the time reached, and the status
PyObject* motion_reach(PyObject* self, PyObject* arguments) {
  double t, steps, reached;
  if (!PyArg_ParseTuple(arguments, "dd", &t, &steps)) return nullptr;
  symtop_status status;
  Py_BEGIN_ALLOW_THREADS
  status = symtop_reach(held(self), t, steps, &reached);
  Py_END_ALLOW_THREADS
  return Py_BuildValue("(di)", reached, static_cast<int>(status));
}

PyObject* motion_kind(PyObject* self, PyObject*) {
  return PyLong_FromLong(symtop_find_kind(held(self)));
}

PyObject* motion_turning_angles(PyObject* self, PyObject*) {
  double angles[2];
  symtop_find_turning_angles(held(self), angles);
  return Py_BuildValue("(dd)", angles[0], angles[1]);
}

PyObject* motion_rates(PyObject* self, PyObject*) {
  symtop_rates r;
  symtop_find_rates(held(self), &r);
  return Py_BuildValue("(ddddi)", r.nutation_period, r.mean_precession_rate, r.mean_spin_rate,
                       r.precession_per_nutation, r.spin_reverses);
}

PyMethodDef MOTION_METHODS[] = {
    {"at", motion_at, METH_O, nullptr},
    {"fill", motion_fill, METH_VARARGS, nullptr},
    {"fill_stamps", motion_fill_stamps, METH_VARARGS, nullptr},
    {"reach", motion_reach, METH_VARARGS, nullptr},
    {"kind", motion_kind, METH_NOARGS, nullptr},
    {"turning_angles", motion_turning_angles, METH_NOARGS, nullptr},
    {"rates", motion_rates, METH_NOARGS, nullptr},
    {nullptr, nullptr, 0, nullptr},
};

PyType_Slot MOTION_SLOTS[] = {
    {Py_tp_new, reinterpret_cast<void*>(new_motion)},
    {Py_tp_dealloc, reinterpret_cast<void*>(dealloc)},
    {Py_tp_methods, MOTION_METHODS},
    {0, nullptr},
};

PyType_Spec MOTION = {"symtop_ros.physics.kernel._kernel.Motion", sizeof(Holder), 0,
                      Py_TPFLAGS_DEFAULT, MOTION_SLOTS};

// ---- Many motions -------------------------------------------------------------------------------

// A motion of an array of starts, freed at the end of its scope; null if it is refused.
class Member {
 public:
  explicit Member(const double* numbers) {
    symtop_start start;
    std::memcpy(&start, numbers, sizeof start);
    symtop_new(&start, &motion);
  }
  ~Member() { symtop_free(motion); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  symtop_motion* motion = nullptr;
};

// fill_many(starts, times, orientation, omega, left): n motions at the same m times. left (n, m) is
// set to 0 for the states that are written; others are too far.
PyObject* fill_many(PyObject*, PyObject* arguments) {
  PyObject *starts, *times, *orientation, *omega, *left;
  if (!PyArg_ParseTuple(arguments, "OOOOO", &starts, &times, &orientation, &omega, &left))
    return nullptr;
  Buffer s(starts, false), t(times, false), q(orientation, true), rates(omega, true),
      l(left, true);
  const Py_ssize_t count = s.bytes() / (NUMBERS * NUMBER), each = t.bytes() / NUMBER;
  const double *start = s.get<double>(NUMBERS * count), *from = t.get<double>(each);
  double *to = q.get<double>(4 * count * each), *to_rates = rates.get<double>(3 * count * each);
  uint8_t* is_left = l.get<uint8_t>(count * each);
  if (PyErr_Occurred()) return nullptr;
  Py_BEGIN_ALLOW_THREADS
  for (Py_ssize_t i = 0; i < count; i++) {
    const Member member(start + NUMBERS * i);
    size_t written = 0;
    if (member.motion)
      symtop_states(member.motion, from, static_cast<size_t>(each), INFINITY, to + 4 * i * each,
                    to_rates + 3 * i * each, &written);
    std::memset(is_left + i * each, 0, written);
  }
  Py_END_ALLOW_THREADS
  Py_RETURN_NONE;
}

// describe_many(starts, kinds, angles, rates): kinds are (n,) of bytes, turning angles (n, 2), and
// rates (n, 5) as symtop_rates has them
PyObject* describe_many(PyObject*, PyObject* arguments) {
  PyObject *starts, *kinds, *angles, *rates;
  if (!PyArg_ParseTuple(arguments, "OOOO", &starts, &kinds, &angles, &rates)) return nullptr;
  Buffer s(starts, false), k(kinds, true), a(angles, true), r(rates, true);
  const Py_ssize_t count = s.bytes() / (NUMBERS * NUMBER);
  const double* start = s.get<double>(NUMBERS * count);
  uint8_t* kind = k.get<uint8_t>(count);
  double *angle = a.get<double>(2 * count), *rate = r.get<double>(5 * count);
  if (PyErr_Occurred()) return nullptr;
  bool is_done = true;
  Py_BEGIN_ALLOW_THREADS
  for (Py_ssize_t i = 0; i < count && is_done; i++) {
    const Member member(start + NUMBERS * i);
    is_done = member.motion != nullptr;
    if (!is_done) break;
    symtop_rates found;
    kind[i] = static_cast<uint8_t>(symtop_find_kind(member.motion));
    symtop_find_turning_angles(member.motion, angle + 2 * i);
    symtop_find_rates(member.motion, &found);
    const double numbers[] = {found.nutation_period, found.mean_precession_rate,
                              found.mean_spin_rate, found.precession_per_nutation,
                              static_cast<double>(found.spin_reverses)};
    std::memcpy(rate + 5 * i, numbers, sizeof numbers);
  }
  Py_END_ALLOW_THREADS
  if (!is_done) return PyErr_NoMemory();
  Py_RETURN_NONE;
}

PyMethodDef METHODS[] = {
    {"fill_many", fill_many, METH_VARARGS, nullptr},
    {"describe_many", describe_many, METH_VARARGS, nullptr},
    {nullptr, nullptr, 0, nullptr},
};

int execute(PyObject* module) {
  PyObject* type = PyType_FromSpec(&MOTION);
  if (!type) return -1;
  const int result = PyModule_AddObjectRef(module, "Motion", type);
  Py_DECREF(type);
  return result;
}

PyModuleDef_Slot SLOTS[] = {{Py_mod_exec, reinterpret_cast<void*>(execute)}, {0, nullptr}};

PyModuleDef MODULE = {PyModuleDef_HEAD_INIT, "_kernel", nullptr, 0, METHODS, SLOTS,
                      nullptr, nullptr, nullptr};

}  // namespace

PyMODINIT_FUNC PyInit__kernel() { return PyModuleDef_Init(&MODULE); }
