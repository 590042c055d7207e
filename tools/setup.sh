#!/bin/sh
# One step of what the Makefile sets up:
# tools/setup.sh venv|tools|sources|module|wheel|extra NAME|pytest|tests|bench|book|web|sanitize
# or a question: tools/setup.sh extras EXERCISE
# Says in a line what it does, and on a terminal how far it is; a tool's own output appears only when it fails.
set -u

log=.venv/setup.log
python=.venv/bin/python

say() { printf '%s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 2; }
have() { command -v "$1" >/dev/null 2>&1; }

# How to install something here: remedy APT-NAMES DNF-NAMES MACOS-COMMAND OTHERWISE
remedy() {
    sudo='sudo '
    [ "$(id -u)" = 0 ] && sudo=
    if have apt-get && [ -n "$1" ]; then say "install it with '${sudo}apt-get install $1'"
    elif have dnf; then say "install it with '${sudo}dnf install $2'"
    elif [ "$(uname)" = Darwin ]; then say "install it with '$3'"
    else say "install $4"
    fi
}
any_system="it with 'curl -LsSf https://astral.sh/uv/install.sh | sh; ~/.local/bin/uv python install 3.12'"

# PYTHON if it is set, else the first of the usual names that is new enough.
find_python() {
    if [ -n "${PYTHON:-}" ]; then set -- "$PYTHON"
    else set -- python3 python3.13 python3.12 python3.11 python3.10 python3.14 /usr/bin/python3 ~/.local/bin/python3.12
    fi
    old=
    for candidate in "$@"; do
        version=$("$candidate" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null) || continue
        case $version in
            2.*|3.?) old="${old:-$candidate is Python $version}" ;;
            *) return ;;
        esac
    done
    if [ -n "${PYTHON:-}" ]; then
        fail "${old:-PYTHON=$PYTHON does not start a Python}: name Python 3.10 or newer, or leave PYTHON out"
    elif [ -n "$old" ]; then
        fail "Python 3.10 or newer is needed, but $old:" \
            "$(remedy "" "python3.12 python3.12-devel" "brew install python@3.12" "$any_system")"
    fi
    fail "Python 3.10 or newer is needed and there is none:" \
        "$(remedy "python3 python3-venv python3-dev" "python3 python3-devel" "brew install python@3.12" "$any_system")"
}

# What venv and the compiler need of an interpreter; Debian and Fedora package these apart.
check_python() {
    "$candidate" -c 'import venv, ensurepip' 2>/dev/null ||
        fail "$candidate lacks its venv module:" \
            "$(remedy "python$version-venv" "python$version" "brew reinstall python@$version" \
                "your system's package of Python's venv and ensurepip modules")"
    [ -d lib/botschool ] || return 0  # nothing is compiled
    "$candidate" -c 'import os, sysconfig; os.stat(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null ||
        fail "$candidate lacks the header files that the C++ module needs:" \
            "$(remedy "python$version-dev" "python$version-devel" "brew reinstall python@$version" \
                "your system's package of Python's header files")"
}

# CXX if it is set, else the first of the usual names (a Python may bring another one's name along).
check_compiler() {
    [ -d lib/botschool ] || return 0
    if [ -n "${CXX:-}" ]; then
        have "${CXX%% *}" && return
        fail "CXX=$CXX names a C++ compiler that is not there: unset it or correct it"
    elif [ "$(uname)" = Darwin ]; then xcode-select -p >/dev/null 2>&1 && return
    else
        for CXX in c++ g++ clang++; do
            have "$CXX" && export CXX && return
        done
    fi
    fail "a C++ compiler is needed and there is none:" \
        "$(remedy g++ gcc-c++ "xcode-select --install" "your system's package of GCC or Clang")"
}

# quietly COMMAND...: its output goes to the log, and to the screen only if it fails
quietly() {
    show_progress last_words
    "$@" >"$log" 2>&1
    failed=$?
    hide_progress
    [ "$failed" = 0 ] || show_failure
}

# show_progress QUESTION: on a terminal, a line that renews itself: the seconds, and what QUESTION answers
show_progress() {
    progress=
    [ -t 1 ] || return 0
    (
        seconds=0
        while sleep 1 && kill -0 $$ 2>/dev/null; do
            seconds=$((seconds + 1))
            printf '\r\033[K  %s s  %.66s' "$seconds" "$("$1")"
        done
    ) &
    progress=$!
}
hide_progress() {
    [ -n "$progress" ] || return 0
    kill "$progress" 2>/dev/null && wait "$progress" 2>/dev/null
    progress=
    printf '\r\033[K'
}
trap 'hide_progress; wait; exit 130' INT TERM
progress=

last_words() { tail -n 1 "$log" 2>/dev/null; }

compiled_files() {
    now=$(find build/editable -name '*.o' -newer .venv/.began 2>/dev/null | wc -l)
    all=$(grep -c '^build [^:]*\.o: ' build/editable/build.ninja 2>/dev/null)
    if [ -f .venv/.module ]; then echo "$((now)) files compiled"; else echo "$((now)) of ${all:-all} files compiled"; fi
}

show_failure() {
    grep -vE '^(Requirement already|Collecting|Processing|Looking) | (Downloading|Using cached|━)' "$log" >&2
    if without_network; then
        fail "this step failed (its output is above): packages come from the network, is it there?"
    fi
    fail "this step failed (its output is above): run make again when the cause is mended"
}

without_network() {
    grep -qE 'connection broken|ConnectionError|name resolution|Read timed out' "$log"
}

pip_install() {
    quietly run_pip "$@"
}

run_pip() {
    marked env PIP_USER=0 "$python" -m pip install --no-input --disable-pip-version-check -c constraints.txt "$@"
}

# install PACKAGES...: by uv, which takes 2 s where pip takes 17; what uv cannot do, pip does
install() {
    quietly run_install "$@"
}

run_install() {
    run_uv "$@" || run_pip "$@"
}

run_uv() {
    if [ -x .venv/bin/uv ]; then uv=.venv/bin/uv; else uv=$(command -v uv) || return 1; fi
    (
        eval "$("$python" -m pip config list 2>/dev/null | as_uv_has_it)"
        marked env UV_INDEX_STRATEGY=unsafe-best-match "$uv" pip install --python "$python" -c constraints.txt "$@"
    )
}

# What pip is told about indexes, wheels and certificates
as_uv_has_it() {
    sed -n -e "s/\\\\n/ /g" \
        -e "s/^[^=]*\.index-url='\([^']*\)'$/export UV_DEFAULT_INDEX='\1'/p" \
        -e "s/^[^=]*\.extra-index-url='\([^']*\)'$/export UV_INDEX='\1'/p" \
        -e "s/^[^=]*\.cert='\([^']*\)'$/export SSL_CERT_FILE='\1'/p" \
        -e "/\.find-links=/ { s/ /,/g; s/^[^=]*='\([^']*\)'$/export UV_FIND_LINKS='\1'/p; }"
}

# marked COMMAND...: leaves a mark while it runs, by which the next make sees that it was interrupted
marked() {
    mark=$(mktemp .venv/.installing-XXXXXX)
    "$@"
    marked=$?
    rm -f "$mark"
    return $marked
}

interrupted() {
    for mark in .venv/.installing-*; do
        [ -e "$mark" ] && return
    done
    return 1
}

# Packages of which files are missing or cut short are forgotten and installed again; the rest stays as it is.
mend() {
    say "The last installation was interrupted: installing again what is half there"
    names=$("$python" tools/half_installed.py) || fail "the packages of .venv cannot be listed: 'make clean' removes it, for the next make to begin anew"
    # shellcheck disable=SC2086
    [ -z "$names" ] || pip_install --no-deps $names
    rm -f .venv/.installing-*
}

# Which interpreter .venv was made with, and where: a virtual environment cannot be moved.
identity() {
    "$1" -c 'import os, sys; print(sys.version.split()[0], sys.base_prefix, os.getcwd())' 2>/dev/null
}

make_venv() {
    if [ -f .venv/.made ] && [ "$(identity "$python")" = "$(cat .venv/.made)" ]; then
        if [ -z "${PYTHON:-}" ] || [ "$(identity "$PYTHON")" = "$(cat .venv/.made)" ]; then
            ! interrupted || mend
            return
        fi
    fi
    rmdir .venv 2>/dev/null
    if [ -e .venv ] && [ ! -f .venv/.ours ]; then
        fail ".venv is here already and was not made by make; move it away with 'mv .venv my-venv'"
    fi
    find_python
    check_python
    check_compiler
    why=
    [ ! -f .venv/.made ] || why=", as the old one is of another Python or another folder"
    say "Making .venv with $("$candidate" -V) (a few seconds)$why"
    mkdir -p build && rm -rf build/old-venv
    [ -e .venv ] && mv .venv build/old-venv
    rm -rf build/old-venv
    mkdir .venv && touch .venv/.ours && quietly make_python
    identity "$python" >.venv/.made
}

# An environment with uv and pip. The pip of its interpreter, where there is one, brings uv, and uv brings
# pip: that takes a fraction of what Python's own way takes (ensurepip), which does all the rest.
make_python() {
    "$candidate" -m venv --without-pip .venv || return
    base_pip="$candidate -m pip --python $python --disable-pip-version-check"
    if $base_pip install --no-input --only-binary :all: uv && settings=$($base_pip config list) &&
        (eval "$(say "$settings" | as_uv_has_it)"; .venv/bin/uv pip install --python "$python" pip)
    then return; fi
    "$python" -m ensurepip --upgrade --default-pip
}

install_tools() {
    say "Installing the build tools (a few seconds)"
    [ -x .venv/bin/uv ] || have uv || run_pip --only-binary :all: uv >"$log" 2>&1  # where it has no wheel, pip installs all
    install scikit-build-core nanobind
    # cmake and ninja, where the system has none that is new enough
    missing=$("$python" -c 'from scikit_build_core.build import get_requires_for_build_editable as requires
print(*(r.replace(" ", "") for r in requires()))') || fail "pyproject.toml cannot be read by scikit-build-core"
    # shellcheck disable=SC2086
    [ -z "$missing" ] || install $missing
}

build_module() {
    check_compiler
    touch .venv/.began
    if [ -f .venv/.module ] && [ .venv/.module -nt .venv/.sources ] && [ .venv/.module -nt .venv/.tools ] &&
        [ -f build/editable/build.ninja ]; then
        say "Compiling what changed of the C++ module (up to a minute)"
        show_progress compiled_files
        recompile >"$log" 2>&1
        failed=$?
    else
        say "Compiling the C++ module and installing packages at the same time (about a minute on two free cores)"
        [ -f .venv/.module ] || rm -rf build/editable
        # packages come through the network while the compiler works
        "$python" -c 'try: import tomllib
except ImportError: import tomli as tomllib
print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"], sep="\n")' >.venv/.dependencies ||
            fail "pyproject.toml cannot be read"
        run_install -r .venv/.dependencies >.venv/packages.log 2>&1 &
        packages=$!
        show_progress compiled_files
        run_pip --no-deps --no-build-isolation -e . >"$log" 2>&1
        failed=$?
        wait "$packages" || log=.venv/packages.log failed=1
    fi
    hide_progress
    [ "$failed" = 0 ] || show_failure
}

# In a copy that brings wheels: installs the one for this Python and system, and what it needs.
install_wheel() {
    say "Installing botschool from $(ls wheels | tr '\n' ' ')(up to a minute)"
    run_pip --no-index --find-links wheels --no-deps --force-reinstall botschool >"$log" 2>&1 ||
        fail "none of these wheels is for $("$python" -V) on this system: ask your instructor for another one"
    have uv || run_pip --only-binary :all: uv >"$log" 2>&1
    install botschool
}

# Compiles and puts the module where it is imported from, and the command beside Python, without asking pip.
recompile() {
    PATH="$PWD/.venv/bin:$PATH" cmake --build build/editable --target _core launcher &&
        PATH="$PWD/.venv/bin:$PATH" cmake --install build/editable --strip --component module --prefix "$PWD/build/installed" &&
        place=$("$python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))') &&
        mv -f build/installed/botschool/_core* "$place/botschool/" &&
        cp build/editable/botschool build/installed/launcher && mv -f build/installed/launcher .venv/bin/botschool
}

# The extras of pyproject.toml that an exercise (3, or a task of it, 3.2) needs: its grader says extras=("NAME",).
extras_of() {
    number=${1%%.*}; number=${number#0}
    cat "exercises/ex$(printf %02d "$number" 2>/dev/null)"_*/test_*.py 2>/dev/null |
        sed -n 's/.*extras=(\([^)]*\)).*/\1/p' | tr -d '",'
}

# The exercises that need an extra, as " (exercises 9 and 10)"
exercises_with() {
    found=
    for folder in exercises/ex[0-9][0-9]_*; do
        number=${folder#exercises/ex}; number=${number%%_*}; number=${number#0}
        case " $(extras_of "$number") " in *" $1 "*) found="$found${found:+, }$number" ;; esac
    done
    case $found in
        "") ;;
        *,*) say " (exercises $found)" | sed 's/\(.*\), /\1 and /' ;;
        *) say " (exercise $found)" ;;
    esac
}

# Of an extra, what may have no wheel; and what it brings, in words
package_of() {
    case $1 in
        rl) say torch ;;
        notebook) say jupyterlab ;;
        atari) say ale-py ;;
        book) say sphinx ;;
        *) say "$1" ;;
    esac
}
title() {
    case $1 in
        box2d) say "Box2D" ;;
        pybullet) say "PyBullet" ;;
        rl) say "PyTorch and Stable-Baselines3" ;;
        notebook) say "JupyterLab and jupytext" ;;
        atari) say "Atari's games and OpenCV" ;;
        book) say "Sphinx, which makes the book" ;;
        *) say "$1" ;;
    esac
}

# try_extra NAME: installs its packages; false if one of them has no wheel for this Python and system.
try_extra() {
    package=$(package_of "$1")
    set -- "$1" "botschool[$1]"
    case $1 in
        pybullet) # and what exercise 10 builds, where it is (a student's copy has none)
            [ ! -d envs/balance_bot ] || set -- "$@" -e envs/balance_bot ;;
        rl)
            [ -z "${TORCH:-}" ] || set -- "$@" --extra-index-url https://download.pytorch.org/whl/cpu ;;
    esac
    shift
    show_progress last_words
    run_pip --only-binary "$package" "$@" >"$log" 2>&1
    failed=$?
    hide_progress
    [ "$failed" != 0 ] || return 0
    without_network || has_wheel "$package" || return 1
    show_failure
}

# What pip says of a failed installation differs, so it is asked for the wheel alone.
has_wheel() {
    pinned=$(sed -n "s/^\($1==[^; ]*\).*/\1/p" constraints.txt 2>/dev/null)
    answer=$("$python" -m pip download --no-deps --only-binary :all: -d build/wheel "${pinned:-$1}" 2>&1) && return
    case $answer in *"No matching distribution found"*) return 1 ;; esac
}

# without EXTRAS GOAL: which of them have no wheel here, and how to get them all the same.
without() {
    say "No wheels for Python $("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])') on this system:"
    names=
    for extra in $1; do
        say "  $(title "$extra")$(exercises_with "$extra")"
        names="$names${names:+,}$extra"
    done
    say "Python 3.11 on Linux (x86-64) has them: PYTHON=python3.11 make $2. To compile them for this one:" \
        ".venv/bin/python -m pip install 'botschool[$names]'"
}

install_extra() {
    say "Installing $(title "$1") (up to two minutes)"
    try_extra "$1" || case $1 in
        pybullet) say "Notice: PyBullet has no wheel for this Python and system. Exercise 10 simulates without it." ;;
        *) fail "$(without "$1" build)" ;;
    esac
    touch ".venv/.extra-$1"
}

install_pytest() {
    say "Installing pytest and what all tests need (a few seconds)"
    install 'botschool[test]'
}

# All that the tests can use; tests of what has no wheel here are skipped.
install_tests() {
    say "Installing PyTorch, Box2D and other packages that some tests need (one to three minutes)"
    left=
    for extra in box2d pybullet atari rl; do
        if try_extra "$extra"; then touch ".venv/.extra-$extra"; else left="$left $extra"; fi
    done
    case $left in *pybullet*) ;; *) pip_install 'botschool[compare]' ;; esac
    [ -z "$left" ] || say "Notice: some tests will be skipped. $(without "$left" test)"
}

# The list of Python files: installed again when it changes, so that all are found where they are.
list_sources() {
    find lib/botschool -name '*.py' | sort >.venv/.sources-now
    if cmp -s .venv/.sources-now .venv/.sources; then rm .venv/.sources-now
    else mv .venv/.sources-now .venv/.sources
    fi
}

install_bench() {
    say "Installing gymnax and EnvPool, to compare with (1 GB, some minutes)"
    pip_install 'botschool[bench]'
}

build_sanitized() {
    check_compiler
    say "Compiling the C++ tests with sanitizers (some minutes)"
    PATH="$PWD/.venv/bin:$PATH"
    quietly cmake -S lib -B build/sanitize -DBOTSCHOOL_SANITIZE=ON
    quietly cmake --build build/sanitize --parallel "$(getconf _NPROCESSORS_ONLN)" --target core_tests
}

# The core of pages, as WebAssembly: the ziglang wheel is compiler, linker and C++ library in one.
build_web() {
    install 'botschool[web]'
    say "Compiling the core for pages (two minutes, the first time)"
    printf '#!/bin/sh\nexec "%s" -m ziglang c++ "$@"\n' "$PWD/$python" >.venv/web-compiler
    chmod +x .venv/web-compiler
    PATH="$PWD/.venv/bin:$PATH"
    for part in classic discrim predprey planar bodybrain spatial; do
        quietly cmake -G Ninja -S lib -B build/web/$part -DBOTSCHOOL_WEB=$part -DCMAKE_SYSTEM_NAME=Generic \
            -DCMAKE_SYSTEM_PROCESSOR=wasm32 -DCMAKE_CXX_COMPILER="$PWD/.venv/web-compiler" \
            -DCMAKE_CXX_COMPILER_WORKS=ON -DCMAKE_CXX_FLAGS="-target wasm32-wasi -msimd128 -w"
        quietly cmake --build build/web/$part
        mv -f build/web/$part/$part.wasm lib/botschool/page/
    done
    "$python" tools/core_sources.py >lib/botschool/page/core_sources.txt
}

build_book() {
    say "Building the book (a minute)"
    quietly .venv/bin/sphinx-build -W --keep-going -q -b html -c docs/book -d build/book . results/book
    say '<meta http-equiv="refresh" content="0; url=docs/book/index.html">' >results/book/index.html
    say "Open results/book/index.html in a browser."
}

case ${TORCH:-cpu} in
    cpu) ;;
    *) fail "TORCH=$TORCH is not known: TORCH=cpu installs PyTorch without its CUDA packages" ;;
esac
case $1 in
    venv) make_venv ;;
    tools) install_tools && touch .venv/.tools ;;
    sources) list_sources ;;
    module) build_module && touch .venv/.module ;;
    wheel) install_wheel && touch .venv/.module ;;
    extra) install_extra "$2" ;;
    extras) extras_of "$2" ;;
    pytest) install_pytest && touch .venv/.pytest ;;
    tests) install_tests && touch .venv/.tests ;;
    bench) install_bench && touch .venv/.bench ;;
    book) build_book ;;
    web) build_web ;;
    sanitize) build_sanitized ;;
    check-arm) install 'botschool[web]' && exec tools/check_arm.sh ;;
esac
