#pragma once

#include <Python.h>
#include <unistd.h>

namespace fiber::python {

/// Lets other threads of Python run as long as it lives.
///
/// pybind11's own class for this ends the process where a thread comes back from a long call while
/// Python is shutting down, as threads of rospy do: Python then ends the thread in a destructor
/// that may not throw. Here it stays where it is until the process has ended, as later versions of
/// Python have it.
class WithoutPythonLock {
 public:
  WithoutPythonLock() : state_(PyEval_SaveThread()) {}
  // Python may also begin to shut down here and end the thread.
  ~WithoutPythonLock() noexcept(false) {
    while (is_python_ending()) {
      pause();
    }
    PyEval_RestoreThread(state_);
  }
  WithoutPythonLock(const WithoutPythonLock&) = delete;
  WithoutPythonLock& operator=(const WithoutPythonLock&) = delete;

 private:
  static bool is_python_ending() {
#if PY_VERSION_HEX >= 0x030D0000
    return Py_IsFinalizing() != 0;
#else
    return _Py_IsFinalizing() != 0;
#endif
  }

  PyThreadState* state_;
};

}  // namespace fiber::python
