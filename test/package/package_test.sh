#!/usr/bin/env bash
# Installs a build into an empty folder and uses it from outside, as plain CMake and, where it is one, as a
# catkin package: the examples must build, run, and answer.
#   package_test.sh BUILD SOURCE FLAGS [MPIEXEC...]
#     FLAGS     for the compiler
#     MPIEXEC   starts ranks, with its flags, the last one before the number of ranks; without, the library for
#               clusters must not be there
set -euo pipefail
build=$1
source=$2
flags=$3
mpiexec=("${@:4}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

fail() {
  echo "package_test: $*" >&2
  exit 1
}

# expect_refused TEXT ARGUMENTS [OPTION...]: configuring a project that asks for these, with these options of CMake,
# fails, and says this.
expect_refused() {
  local text=$1 arguments=$2
  shift 2
  mkdir -p "$work/refused"
  printf 'cmake_minimum_required(VERSION 3.16)\nproject(refused CXX)\nfind_package(fiber_proximity %s)\n' "$arguments" \
    >"$work/refused/CMakeLists.txt"
  if cmake -S "$work/refused" -B "$work/refused-build" -DCMAKE_PREFIX_PATH="$prefix" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@" >"$work/refused.log" 2>&1; then
    fail "find_package(fiber_proximity $arguments) was not refused"
  fi
  # CMake breaks lines.
  grep -qF "$text" <<<"$(tr -s ' \n' ' ' <"$work/refused.log")" || { cat "$work/refused.log"; fail "no word of: $text"; }
  rm -rf "$work/refused-build"
}

cmake --install "$build" --prefix "$prefix" >"$work/install.log"
if [ -n "$(find "$prefix" -path '*include*' \( -name '*-inl.hpp' -o -name '*interface_table*' \))" ]; then
  fail "a private header is installed"
fi
# Nothing that only tests and benchmarks are made of is in an installed library.
# defined FILE… [-D]: names of what these define once and for all; templates and inline functions are everybody's.
defined() {
  nm --defined-only -g "$@" 2>/dev/null | awk '$2 ~ /^[TDBR]$/ { print $3 }' | sort -u
}
mapfile -t archives < <(
  find "$build" -path "$build/sanitize*" -prune -o \( -name libvalidation_geometry.a -o -name libvalidation_sim.a -o -name libtest_support.a -o -name 'libfiber_bench_*.a' \) -print)
defined "${archives[@]}" >"$work/test_symbols.txt"
grep -q hard_pairs "$work/test_symbols.txt" || fail "no symbols of test code are found"
while IFS= read -r library; do
  defined -D "$library" | comm -12 - "$work/test_symbols.txt" >"$work/both.txt"
  [ ! -s "$work/both.txt" ] || fail "$library has code of tests: $(c++filt <"$work/both.txt")"
done < <(find "$prefix" -name 'libfiber_proximity*.so')

cmake -S "$source/examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_CXX_FLAGS="$flags" >"$work/configure.log" || { cat "$work/configure.log"; exit 1; }
for made in CATKIN_IGNORE devel catkin catkin_generated test_results; do
  [ ! -e "$work/examples/$made" ] || fail "catkin makes its $made in a project that asks for components"
done
cmake --build "$work/examples" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
"$work/examples/first_query" | tee "$work/first_query.txt"
grep -q "^fibre 0 segment 1 and fibre 1 segment 0: 0.0020 m apart" "$work/first_query.txt" ||
  fail "first_query has another answer"
"$work/examples/engine_loop" | tee "$work/engine_loop.txt"
grep -q "the first after" "$work/engine_loop.txt" || fail "engine_loop finds no contact"
"$work/examples/check_candidates" | tee "$work/check_candidates.txt"
[ "$(cut -d' ' -f3- "$work/check_candidates.txt" | tr '\n' ';')" = "floor;post;post;free;the cable that is there;free;" ] ||
  fail "check_candidates has another answer"
"$work/examples/simulate_scene" "$source/config/sim/hanging_cable.yaml" >"$work/simulate.txt"
first=$(head -n 1 "$work/simulate.txt")
[ "${first#*: }" != "$(tail -n 1 "$work/simulate.txt" | sed 's/^[^:]*: //')" ] || fail "the simulation stands still"
"$work/examples/own_effect" | tee "$work/own_effect.txt"
grep -q "^0.0 s: the middle is at 1.000 0.000 0.000" "$work/own_effect.txt" || fail "own_effect begins elsewhere"
# A rod of 2.5 g between three springs of 0.01 N/m turns back after 0.9 s.
awk '$7 >= last && NR > 1 { exit 1 } { last = $7 } END { exit !(last < 0.7) }' "$work/own_effect.txt" ||
  fail "the trap of own_effect does not pull"
if "$work/examples/simulate_scene" "$work/none.yaml" 2>"$work/error.txt"; then
  fail "a scene that is not there is no error"
fi
grep -q "none.yaml" "$work/error.txt" || fail "the error does not name the file"

# expect_paper_engines FOLDER: the program of this build has the engine of the paper that it calls for.
expect_paper_engines() {
  local answer
  answer=$("$(find "$1" -name paper_engines -type f)" 2>&1) || fail "paper_engines of $1: $answer"
  [ "$answer" = "AL: 1 contact, 0.5 m" ] || fail "paper_engines of $1 has another answer: $answer"
}
# shellcheck disable=SC2016  # the quotes of Markdown
sed -n '/^## In C++$/,/^## /{/^```cpp$/,/^```$/{/^```/!p}}' "$source/README.md" >"$work/readme.cpp"
cmake -S "$source/test/package/cmake_user" -B "$work/cmake_user" -DCMAKE_PREFIX_PATH="$prefix" \
  -DREADME_PROGRAM="$work/readme.cpp" \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_CXX_FLAGS="$flags" >"$work/configure.log" ||
  { cat "$work/configure.log"; exit 1; }
cmake --build "$work/cmake_user" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
expect_paper_engines "$work/cmake_user"
"$work/cmake_user/readme" | grep -q '^0 and 1: 0.002 m, from ' || fail "the README's program finds no contact"
[ "$("$work/cmake_user/yaml_environment" | tr '\n' ' ')" = "touches free touches " ] ||
  fail "yaml_environment has another answer"
[ "$("$work/cmake_user/scene_fibers")" = "5 cables" ] || fail "scene_fibers makes other fibres"
# The paper's engines are loaded by those tools alone that offer them by name.
for tool in fiber_scene fiber_simulate fiber_scene_mpi fiber_query_mpi; do
  program=$(find "$prefix" -name "$tool" -type f)
  [ -n "$program" ] || continue
  [[ $(ldd "$program") != *libfiber_proximity_paper* ]] || fail "$tool loads the paper's engines"
done
# What is linked is for the consumer to say.
if grep -r LINK_OPTIONS "$prefix" --include='fiber_proximity-*.cmake'; then
  fail "a component has linker options for its consumers"
fi

if [ "${#mpiexec[@]}" -gt 0 ]; then
  "${mpiexec[@]}" 3 "$work/examples/contacts_over_ranks" | tee "$work/ranks.txt"
  [ "$(grep -c '^fibre [012] segment [01] and fibre [012] segment [01]: 0.0010 m apart$' "$work/ranks.txt")" -eq 8 ] ||
    fail "contacts_over_ranks has another answer"
  # To an MPI that is not there, the other components are still there.
  expect_refused "'mpi' of fiber_proximity needs MPI for C++" "REQUIRED COMPONENTS core mpi" -DCMAKE_DISABLE_FIND_PACKAGE_MPI=ON
  find "$prefix" -name fiber_proximity-mpi.cmake -delete
else
  left=$(find "$prefix" -name mpi -o -name '*[-_]mpi*')
  [ -z "$left" ] || fail "installed without MPI: $left"
  [ ! -e "$work/examples/contacts_over_ranks" ] || fail "contacts_over_ranks is built without MPI"
fi
expect_refused "'mpi' of fiber_proximity is not installed" "REQUIRED COMPONENTS core mpi"

# Python knows no sanitizer.
module=$(find "$prefix" -name '_native*.so')
if [ -n "$module" ] && [[ $flags != *fsanitize* ]]; then
  python_path=$(dirname "$(dirname "$module")")
  # Not the libraries of the build, which catkin's setup.bash has put first.
  answer=$(cd "$work" && PYTHONPATH=$python_path:${PYTHONPATH:-} env -u LD_LIBRARY_PATH /usr/bin/python3 -B -c \
    'import fiber_proximity as fp; print(fp.Engine(fp.Fibers([[0, 0, 0], [1, 0, 0]])).nearest([0, 1, 0])["distance"])')
  [ "$answer" = "[1.]" ] ||
    fail "the Python module does not answer from where it is installed"
  # What it loads is what is installed beside it.
  [[ $(env -u LD_LIBRARY_PATH ldd "$module") == *"$prefix"*libfiber_proximity.so.* ]] || fail "the Python module loads another library"
  if [ -d "$python_path/fiber_proximity/msg" ]; then
    (cd "$work" && PYTHONPATH=$python_path:${PYTHONPATH:-} /usr/bin/python3 -B -c \
      'import fiber_proximity; fiber_proximity.Engine(); from fiber_proximity.msg import Contact; Contact()') ||
      fail "module and messages are not one package where they are installed"
  fi
fi

expect_refused "has no component 'gui'" "REQUIRED COMPONENTS gui"
expect_refused "99.0" "99.0 REQUIRED"
find "$prefix" -name fiber_proximity-sim.cmake -delete
expect_refused "'sim' of fiber_proximity is not installed" "REQUIRED COMPONENTS core sim"

config=$(find "$prefix" -name fiber_proximityConfig.cmake)
if grep -q catkin "$config"; then
  cmake -S "$source/test/package/catkin_user" -B "$work/catkin" -DEXAMPLES="$source/examples" \
    -DCMAKE_PREFIX_PATH="$prefix;/usr" -DPYTHON_EXECUTABLE=/usr/bin/python3 >"$work/configure.log" 2>&1 ||
    { cat "$work/configure.log"; exit 1; }
  cmake --build "$work/catkin" >"$work/build.log" || { cat "$work/build.log"; exit 1; }
  "$(find "$work/catkin/devel" -name first_query -type f)" | diff - "$work/first_query.txt" ||
    fail "first_query of the catkin package has another answer"
  # Not through a pipe: grep ends it early, and ldd then fails now and then.
  linked=$(ldd "$(find "$work/catkin/devel" -name contact_node -type f)")
  [[ $linked == *libfiber_proximity_ros* ]] || fail "contact_node does not link the library"
  expect_paper_engines "$work/catkin/devel"
fi
