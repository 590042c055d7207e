#!/bin/sh
# The recorded runs of tests/engine/test_golden.py on 64-bit ARM, emulated on an x86 machine with Debian or Ubuntu, and the core
# compiled for macOS and Windows: `make check-arm`. Needs qemu-user and g++-aarch64-linux-gnu. Some 15 minutes of two cores.
set -eu

fail() { printf 'error: %s\n' "$*" >&2; exit 2; }
for tool in qemu-aarch64 aarch64-linux-gnu-g++ dpkg; do
    command -v "$tool" >/dev/null || fail "$tool is missing: apt-get install qemu-user g++-aarch64-linux-gnu"
done
here=$PWD python=$PWD/.venv/bin/python folder=$PWD/build/arm
cmake=$here/.venv/bin/cmake
[ -x "$cmake" ] || cmake=cmake

# An ARM Python of the distribution, unpacked beside the system's
mkdir -p "$folder/lists/partial" "$folder/debs" "$folder/root"
if [ ! -e "$folder/root/usr/bin/python3" ]; then
    echo "Fetching an ARM Python and its packages (some minutes)"
    options="-qq -oAPT::Architecture=arm64 -oAPT::Architectures=arm64 -oDir::State::Lists=$folder/lists -oAPT::Sandbox::User=root"
    # shellcheck disable=SC2086
    apt-get $options update
    version=$(apt-cache -oAPT::Architecture=arm64 -oAPT::Architectures=arm64 -oDir::State::Lists="$folder/lists" depends python3-minimal |
        sed -n 's/.*Depends: python\(3\.[0-9]*\)-minimal.*/\1/p' | head -n 1)
    # shellcheck disable=SC2086
    (cd "$folder/debs" && apt-get $options download "python$version-minimal" "libpython$version-minimal" \
        "libpython$version-stdlib" "libpython$version-dev" libc6 libstdc++6 libgcc-s1 zlib1g libexpat1 libffi8 \
        libssl3 libbz2-1.0 liblzma5 libsqlite3-0)
    for package in "$folder"/debs/*.deb; do dpkg -x "$package" "$folder/root"; done
    ln -sf "python$version" "$folder/root/usr/bin/python3"
fi
version=$(readlink "$folder/root/usr/bin/python3")
platforms=$(for n in 17 27 28 34; do printf -- '--platform manylinux_2_%s_aarch64 ' $n; done)
# shellcheck disable=SC2086
[ -d "$folder/site" ] || "$python" -m pip install -q --target "$folder/site" --platform manylinux2014_aarch64 $platforms \
    --python-version "${version#python}" --implementation cp --only-binary :all: -c constraints.txt \
    numpy 'gymnasium[classic-control]' typer rich matplotlib imageio tensorboard pyyaml pytest

echo "Compiling the core for ARM"
headers=$folder/root/usr/include
"$cmake" -G Ninja -S lib -B build/arm/module -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
    -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_CXX_FLAGS="-I$headers -I$headers/$version" \
    -DCMAKE_MAKE_PROGRAM="$(command -v ninja || echo "$here/.venv/bin/ninja")" \
    -DPython_EXECUTABLE="$python" -DPython_INCLUDE_DIR="$headers/$version" >build/arm/log
"$cmake" --build build/arm/module --target _core >>build/arm/log
rm -rf build/arm/site/botschool
cp -r lib/botschool build/arm/site/
rm -f build/arm/site/botschool/_core*
cp build/arm/module/_core*.so build/arm/site/botschool/_core.so

# An interpreter that programs can start again as sys.executable
cat >build/arm/python <<END
#!/bin/sh
export PYTHONHOME='$folder/root/usr' PYTHONPATH='$folder/site' QEMU_LD_PREFIX='$folder/root'
exec qemu-aarch64 -0 '$folder/python' '$folder/root/usr/bin/$version' "\$@"
END
chmod +x build/arm/python

echo "Playing the recorded runs on an emulated ARM processor"
build/arm/python tests/engine/test_golden.py >build/arm/golden.json
"$python" - <<'END'
import json
here, there = (json.load(open(name)) for name in ("tests/golden.json", "build/arm/golden.json"))
differ = [name for name in here if here[name] != there.get(name)]
print(f"{len(here) - len(differ)} of {len(here)} runs have the recorded bits" + (f"; not: {differ}" if differ else ""))
raise SystemExit(bool(differ))
END

for target in aarch64-macos x86_64-windows-gnu; do
    echo "Compiling the core for $target"
    printf '#!/bin/sh\nexec "%s" -m ziglang c++ -target %s "$@"\n' "$python" "$target" >"build/arm/$target"
    chmod +x "build/arm/$target"
    for file in lib/evonet/layout.cpp lib/evonet/evonet.cpp lib/evonet/convolution.cpp lib/linear/linear.cpp \
        lib/arena/engine/engine.cpp lib/arena/engine/cpu.cpp lib/arena/robots/jointed/*.cpp lib/policy_gradient/*.cpp; do
        case $file in */kernels.cpp) continue ;; esac  # compiled with a problem, as build/generated has them
        "build/arm/$target" -std=c++17 -fsyntax-only -ffp-contract=off -Ilib -Ibuild/arm/module "$file"
    done
done
