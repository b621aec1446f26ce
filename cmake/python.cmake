# ROS's Python modules belong to the system's interpreter. Another python3 (pyenv, conda) that stands
# first on PATH would be found instead and fail in the message generators, so the system's one is the
# default; -DPYTHON_EXECUTABLE=... still overrides it.
if(NOT DEFINED PYTHON_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that has ROS's modules")
endif()
if(DEFINED PYTHON_EXECUTABLE AND NOT DEFINED Python3_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE} CACHE FILEPATH "Python that has ROS's modules")
endif()
