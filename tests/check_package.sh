#!/bin/bash
# check_package.sh - the packages of tools/package: installed into an empty folder by CMake, then used by CMake and by
# pkg-config from another one, after the sources are gone. vcpkg and Conan are not asked: their files run here with
# stand-ins for the few commands that they call, which call CMake as those would.
. "$(dirname "$0")/checks.sh"
version=$(sed -n 's/^#define GPROJ_VERSION "\(.*\)"$/\1/p' "$root/guidedproj.h")

# ---- one version everywhere, and in the name of the tag, if this commit has one ----

says() { # says WHAT VERSION
    [ "$2" = "$version" ] && pass || fail "$1 says version '$2', the header '$version'"
}
number() { sed -n "s/^#define GPROJ_VERSION_$1 \([0-9]*\)$/\1/p" "$root/guidedproj.h"; }
says 'GPROJ_VERSION_MAJOR, _MINOR' "$(number MAJOR).$(number MINOR)"
says "the header's first line" "$(sed -n '1s/.* - v\([0-9.]*\) - .*/\1/p' "$root/guidedproj.h")"
says vcpkg.json "$(sed -n 's/^ *"version": "\(.*\)",$/\1/p' "$root/tools/package/vcpkg/guidedproj/vcpkg.json")"
says conanfile.py "$(sed -n 's/^    version = "\(.*\)"$/\1/p' "$root/tools/package/conanfile.py")"
tag=$(git -C "$root" tag --points-at HEAD 2>/dev/null | grep '^v[0-9]' | head -n 1)
[ -z "$tag" ] || says 'the tag' "${tag#v}"
have cmake || { skip 'packages: no cmake'; report; }

# ---- a copy of what packages take, which goes away after the installation ----

mkdir -p "$work/source/tools" "$work/bin"
cp "$root/guidedproj.h" "$root/LICENSE" "$work/source"
cp -R "$root/tools/package" "$work/source/tools"

# The library takes long to compile: once with the same options, and without optimising it, which changes nothing here; that
# packages ask for it is looked at below.
cat >"$work/bin/once" <<'END'
#!/bin/bash
object=${*: -1} kept=$0.$(printf '%s ' "$@" | sed 's/[^ ]*\/[^ ]*//g' | cksum | tr -d ' ')
for ((i = 1; i < $#; ++i)); do [ "${!i}" != -o ] || { i=$((i + 1)); object=${!i}; }; done
[[ " $* " = *" -c "* && " $* " = *guidedproj.c* ]] || exec "$@"
[ -f "$kept" ] || "$@" -O0 || exit
[ -f "$kept" ] && cp "$kept" "$object" || cp "$object" "$kept"
END
chmod +x "$work/bin/once"
export CMAKE_C_COMPILER_LAUNCHER=$work/bin/once CMAKE_GENERATOR='Unix Makefiles'
quietly() { # quietly WHAT COMMAND...
    local what=$1
    shift
    if "$@" >"$work/said.txt" 2>&1; then pass; else fail "$what"; tail -n 20 "$work/said.txt" | sed 's/^/  /'; fi
}

# ---- programs that use it ----

mkdir "$work/use"
sed -n '/^     #define GUIDEDPROJ_IMPLEMENTATION/,/^     }/p' "$root/guidedproj.h" | sed 's/^     //' >"$work/use/whole.c"
sed '/^#define GUIDEDPROJ_IMPLEMENTATION/d' "$work/use/whole.c" >"$work/use/roof.c"
cp "$work/use/roof.c" "$work/use/roof2.cpp"
cp "$root/examples/roof.obj" "$work/use"
cat >"$work/use/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.15)
project(use C CXX)
find_package(guidedproj $version REQUIRED)
add_executable(roof roof.c)
target_link_libraries(roof PRIVATE guidedproj::guidedproj)
add_executable(roof2 roof2.cpp)
target_link_libraries(roof2 PRIVATE guidedproj::guidedproj)
add_library(whole OBJECT whole.c) # compiled only: that is all of the library once more
target_link_libraries(whole PRIVATE guidedproj::header)
set_property(TARGET whole PROPERTY EXCLUDE_FROM_ALL ON)
add_library(plug SHARED roof.c)
target_link_libraries(plug PRIVATE guidedproj::guidedproj)
END
solves() { # solves WHAT PROGRAM: it makes the roof flat
    (cd "$work/use" && rm -f flat_panels.obj && "$2" >said.txt 2>&1 && [ -s flat_panels.obj ]) && pass ||
        fail "$1 does not solve: $(head -n 3 "$work/use/said.txt")"
}
use() { # use WHAT PREFIX: by CMake, and by pkg-config
    quietly "$1: configure" cmake -S "$work/use" -B "$work/use-$1" -DCMAKE_PREFIX_PATH="$2"
    quietly "$1: build" cmake --build "$work/use-$1"
    solves "$1, C" "$work/use-$1/roof"
    solves "$1, C++" "$work/use-$1/roof2"
    use_pkg_config "$1" "$2"
}
use_pkg_config() { # use_pkg_config WHAT PREFIX
    mkdir -p "$work/use-$1"
    if have pkg-config; then
        export PKG_CONFIG_PATH=$2/lib/pkgconfig
        [ -f "$PKG_CONFIG_PATH/guidedproj.pc" ] || PKG_CONFIG_PATH=$(dirname "$(find "$2" -name guidedproj.pc | head -n 1)")
        says "pkg-config, $1" "$(pkg-config --modversion guidedproj)"
        quietly "$1: pkg-config" ${CC:-cc} "$work/use/roof.c" $(pkg-config --cflags --libs guidedproj) -o "$work/use-$1/by"
        LD_LIBRARY_PATH=$(pkg-config --variable=libdir guidedproj) solves "$1, pkg-config" "$work/use-$1/by"
    else
        skip "$1: no pkg-config"
    fi
}

# ---- CMake ----

quietly configure cmake -S "$work/source/tools/package" -B "$work/build"
quietly build cmake --build "$work/build"
grep -rq -- ' -O2 .*-std=c99\|-std=c99.* -O2' "$work/build/CMakeFiles/guidedproj.dir/flags.make" && pass || fail 'not -O2, C99'
quietly install cmake --install "$work/build" --prefix "$work/first"
mv "$work/first" "$work/prefix" # packages are moved
quietly 'configure, libdir of two parts' cmake -S "$work/source/tools/package" -B "$work/build-two" \
    -DCMAKE_INSTALL_LIBDIR=lib/of-two
quietly 'build, libdir of two parts' cmake --build "$work/build-two"
quietly 'install, libdir of two parts' cmake --install "$work/build-two" --prefix "$work/second"
mv "$work/second" "$work/two"
cp "$work/source/guidedproj.h" "$work/kept.h"
sed 's/^#define GPROJ_VERSION ".*"/#define GPROJ_VERSION "7.89"/' "$work/kept.h" >"$work/source/guidedproj.h"
quietly 'build of another version' cmake --build "$work/build-two"
grep -q '^Version: 7\.89$' "$work/build-two/guidedproj.pc" && pass || fail 'a build does not notice a new version'
mv "$work/kept.h" "$work/source/guidedproj.h"
mkdir "$work/build-in" && cat >"$work/build-in/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.15)
project(inside C)
add_subdirectory($work/source/tools/package guidedproj)
add_executable(roof $work/use/roof.c)
target_link_libraries(roof PRIVATE guidedproj::guidedproj)
END
quietly 'add_subdirectory' cmake -S "$work/build-in" -B "$work/build-in/b"
quietly 'add_subdirectory: build' cmake --build "$work/build-in/b"
solves add_subdirectory "$work/build-in/b/roof"

# ---- vcpkg: the port's steps, with what vcpkg's own commands do on this system ----

cat >"$work/vcpkg.cmake" <<'END'
set(CURRENT_PACKAGES_DIR "${WORK}/vcpkg")
macro(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endmacro()
function(vcpkg_cmake_configure)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "SOURCE_PATH" "OPTIONS")
    run(${CMAKE_COMMAND} -S ${arg_SOURCE_PATH} -B ${WORK}/vcpkg-build -DCMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR}
        -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=ON ${arg_OPTIONS})
endfunction()
function(vcpkg_cmake_install)
    run(${CMAKE_COMMAND} --build ${WORK}/vcpkg-build --target install)
endfunction()
function(vcpkg_cmake_config_fixup)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "PACKAGE_NAME;CONFIG_PATH" "")
    if(NOT EXISTS "${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH}/guidedproj-config.cmake")
        message(FATAL_ERROR "nothing at ${arg_CONFIG_PATH}")
    endif()
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_install_copyright)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
    file(INSTALL ${arg_FILE_LIST} DESTINATION "${CURRENT_PACKAGES_DIR}/share/guidedproj")
endfunction()
include("${PORT}/portfile.cmake")
END
quietly 'the port' cmake -DWORK="$work" -DPORT="$work/source/tools/package/vcpkg/guidedproj" -P "$work/vcpkg.cmake"
[ -s "$work/vcpkg/share/guidedproj/LICENSE" ] && pass || fail 'the port installs no licence'

# ---- Conan: the recipe's methods, in the order in which Conan calls them ----

if have python3; then
    python3 -m json.tool "$root/tools/package/vcpkg/guidedproj/vcpkg.json" >/dev/null && pass || fail 'vcpkg.json is no JSON'
    mkdir -p "$work/stub/conan/tools"
    cat >"$work/stub/conan/__init__.py" <<'END'
class ConanFile: pass
END
    : >"$work/stub/conan/tools/__init__.py"
    cat >"$work/stub/conan/tools/cmake.py" <<'END'
import os, subprocess
def cmake_layout(recipe): recipe.build_folder = os.path.join(recipe.build_folder, "build")
class CMakeToolchain:
    def __init__(self, recipe): pass
    def generate(self): pass
class CMake:
    def __init__(self, recipe): self.recipe = recipe
    def configure(self, build_script_folder):
        subprocess.check_call(["cmake", "-S", os.path.join(self.recipe.source_folder, build_script_folder), "-B",
                               self.recipe.build_folder])
    def build(self): subprocess.check_call(["cmake", "--build", self.recipe.build_folder])
    def install(self):
        subprocess.check_call(["cmake", "--install", self.recipe.build_folder, "--prefix", self.recipe.package_folder])
END
    cat >"$work/stub/conan/tools/files.py" <<'END'
import fnmatch, os, shutil
def copy(recipe, pattern, src, dst):
    for folder, _, names in os.walk(src):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), src)
            if not fnmatch.fnmatch(path, pattern): continue
            os.makedirs(os.path.dirname(os.path.join(dst, path)), exist_ok=True)
            shutil.copy(os.path.join(src, path), os.path.join(dst, path))
END
    cat >"$work/conan.py" <<'END'
import os, sys, types
work = sys.argv[1]
sys.path[:0] = [work + "/stub", work + "/source/tools/package"]
import conanfile
recipe = conanfile.Guidedproj()
recipe.recipe_folder = work + "/source/tools/package"
recipe.export_sources_folder = recipe.source_folder = work + "/conan-source"
recipe.build_folder, recipe.package_folder = work + "/conan-build", work + "/conan"
recipe.settings = types.SimpleNamespace(os="Linux")
properties = {}
recipe.cpp_info = types.SimpleNamespace(set_property=properties.__setitem__)
for step in "export_sources layout generate build package package_info".split(): getattr(recipe, step)()
assert recipe.cpp_info.libs == ["guidedproj"] and recipe.cpp_info.system_libs == ["m"]
assert properties == {"cmake_target_name": "guidedproj::guidedproj"}
assert sorted(os.listdir(recipe.source_folder)) == ["LICENSE", "guidedproj.h", "tools"]
END
    quietly 'the recipe' python3 -B "$work/conan.py" "$work"
    [ -s "$work/conan/licenses/LICENSE" ] && pass || fail 'the recipe installs no licence'
else
    skip 'vcpkg.json, conanfile.py: no python3'
fi

# ---- all of them, used without the sources ----

rm -rf "$work/source" "$work/build" "$work/build-two" "$work/vcpkg-build" "$work/conan-source" "$work/conan-build"
for prefix in prefix vcpkg $([ ! -d "$work/conan" ] || echo conan); do use $prefix "$work/$prefix"; done
use_pkg_config two "$work/two"
if have g++; then # the interface target, as far as the compiler sees it
    quietly 'guidedproj::header' make -C "$work/use-prefix" -n whole
fi
report
