# Every target sets up what it needs by itself, in .venv and build/, and again only when inputs change.
# Another interpreter: PYTHON=python3.12 make demo
# PyTorch without its CUDA packages (some GB): TORCH=cpu make test-ex11

BIN := .venv/bin
READY := .venv/.module
CPP := $(shell find lib tests -name '*.cpp' -o -name '*.hpp' -o -name '*.h' 2>/dev/null)
CPP_INPUTS := $(filter lib/%,$(CPP)) $(shell find lib -name CMakeLists.txt -o -name '*.cmake' 2>/dev/null)

# Packages that another project put on the path (ROS, for one) would shadow the pinned ones.
unexport PYTHONPATH PYTHONHOME
# Without compiled modules on the disk, each of the many processes would compile the library anew.
unexport PYTHONDONTWRITEBYTECODE
.NOTPARALLEL:
.PHONY: help demo build web clean FORCE

help: ## list these targets
	@awk -F ':.*## ' '/^[a-z%-]+:.*## / { sub("%", "N", $$1); printf "make %-14s %s\n", $$1, $$2 }' Makefile

# A copy that `botschool course` has made has neither source nor wheels: it uses the botschool that is installed.
ifeq ($(wildcard lib/botschool wheels),)
BIN := $(patsubst %/,%,$(dir $(shell command -v botschool || echo .venv/bin/botschool)))
READY := installed
endif
.PHONY: installed
installed:
	@command -v botschool >/dev/null || { echo "error: there is no botschool command here: activate the" \
		"environment that botschool is installed in" >&2; exit 2; }

DEMO := results/demo
demo: $(READY) ## evolve an Acrobot and a hopping robot, draw their curves and film them
	$(BIN)/botschool es -f data/experiments/acrobot.ini -s 1 -w 2 -o $(DEMO)/acrobot --steps 3000000 --force
	$(BIN)/botschool plotstat $(DEMO)/acrobot -o $(DEMO)/acrobot.png
	$(BIN)/botschool es -f data/experiments/acrobot.ini -s 1 -p -g $(DEMO)/acrobot/bestgS1.npy \
		--video $(DEMO)/acrobot.mp4
	$(BIN)/botschool es -f data/experiments/planarhopper.ini -s 1 -w 2 -o $(DEMO)/hopper --steps 10000000 --force
	$(BIN)/botschool plotstat $(DEMO)/hopper -o $(DEMO)/hopper.png
	$(BIN)/botschool es -f data/experiments/planarhopper.ini -s 1 -p -g $(DEMO)/hopper/bestgS1.npy \
		--episodes 1 --video $(DEMO)/hopper.mp4
	@echo "Curves: $(DEMO)/acrobot.png $(DEMO)/hopper.png   Films: $(DEMO)/acrobot.mp4 $(DEMO)/hopper.mp4"

build: $(READY) ## the Python environment and the C++ module

web: .venv/.module ## compile the cores of pages anew, after a change of C++ (some minutes)
	@tools/setup.sh web

# What an exercise trains and simulates with can be large: its grader names the extras it needs.
.SECONDEXPANSION:
extras = $(if $(filter installed,$(READY)),,$(addprefix .venv/.extra-,$(shell tools/setup.sh extras $(1))))

# The student's own file, or SUBMISSION=FOLDER. Points below 100 are a result, no failure of make's: only where
# $CI is set do they end it with an error, as they end `botschool grade` with exit code 1 everywhere.
export SUBMISSION
test-ex%: $(READY) $$(call extras,$$*) FORCE ## grade exercise N; SUBMISSION=FOLDER grades another folder
	@$(BIN)/botschool grade $* $(if $(SUBMISSION),--submission "$$SUBMISSION") || { [ $$? = 1 ] && [ -z "$$CI" ]; }

notebook-ex%: $(READY) $$(call extras,$$*) $(if $(filter installed,$(READY)),,.venv/.extra-notebook) FORCE ## open your file of exercise N as a notebook, in JupyterLab
	@$(BIN)/botschool start $* --notebook

# BEGIN NOT RELEASED
# Tests run in a process for each core, eight at most: WORKERS=3 make test takes three, WORKERS=0 this one alone.
WORKERS ?= auto
PYTEST := $(BIN)/python -m pytest -q -n $(WORKERS) --dist worksteal

.PHONY: book test test-all fuzz check-course check-arm wheels nbgrader figures skeletons bench results lint format sanitize
test: .venv/.tests ## the quick tests
	@$(PYTEST)

test-all: .venv/.tests ## all tests but the proofs of the course
	@$(PYTEST) -m "not course"

book: .venv/.tests .venv/.extra-book ## a website of the texts and documents in results/book, for a folder or any host
	@tools/setup.sh book

solution-ex%: .venv/.module $$(call extras,$$*) FORCE ## run the solution of exercise N in results/exNN
	@$(BIN)/botschool show $* --submission solutions

# So much processor time, in equal shares: SECONDS=3600; some kinds of files: ONLY="ini genotype"; one case again: CASE=12.
SECONDS ?= 60
SEED ?= 1
fuzz: .venv/.tests ## damage files of every kind that the command reads, SECONDS=60, and see what it says
	@$(BIN)/python tests/fuzz $(SECONDS) --seed $(SEED) $(if $(ONLY),--only "$(ONLY)") $(if $(CASE),--case $(CASE))

skeletons: .venv/.module ## generate the exercises' files from the solutions
	@$(BIN)/botschool skeletons

wheels: .venv/.tools ## wheels for Python 3.10, 3.11, and 3.12 and later, in dist; PYTHONS="3.11" builds some
	@$(BIN)/python tools/wheels.py $(PYTHONS)

nbgrader: .venv/.tests ## a course folder for nbgrader in results/nbgrader
	@$(BIN)/botschool nbgrader results/nbgrader

# Of the exercises that ONLY names, the packages that they need; else all that tests use.
checked = $(patsubst ex%,%,$(filter ex%,$(ONLY)))
check-course: $(if $(checked),.venv/.pytest $(foreach n,$(checked),$(call extras,$(n))),.venv/.tests) ## prove that exercises and grading work (one to two hours on two cores); ONLY=ex03: those of exercise 3; SECRETS=5: what depends on the grading seeds
	@$(PYTEST) -m course tests/course$(if $(SECRETS),/test_secrets.py --secrets $(SECRETS)) $(if $(ONLY),-k "$(ONLY)")

check-arm: .venv/.tests ## play the recorded runs on an emulated ARM processor, and compile for macOS and Windows
	@tools/setup.sh check-arm

bench: .venv/.module ## the speed of evaluation beside gymnax, EnvPool and Gymnasium
	@$(BIN)/python tests/bench/run.py

figures: .venv/.tests ## draw the pictures of the exercises' texts anew (docs/images/course)
	@$(BIN)/python tools/figures $(ONLY)

results: .venv/.bench ## measure all of docs/reports/results.md anew and write it (half an hour)
	@$(BIN)/python tools/studies results

lint: .venv/.tests ## check style and types: ruff, mypy and clang-format
	@$(BIN)/ruff check --quiet .
	@$(BIN)/ruff format --check --quiet --diff .
	@$(BIN)/mypy --no-error-summary
	@$(BIN)/clang-format --dry-run --Werror $(CPP)

format: .venv/.tests ## put the style right where a tool can
	@$(BIN)/ruff check --quiet --fix-only .
	@$(BIN)/ruff format --quiet .
	@$(BIN)/clang-format -i $(CPP)

sanitize: .venv/.tools ## the C++ tests under address and undefined-behaviour sanitizers
	@tools/setup.sh sanitize
	@build/sanitize/core_tests
# END NOT RELEASED

clean: ## remove what the targets above set up; results stay
	rm -rf .venv build .pytest_cache .ruff_cache .mypy_cache .hypothesis

# Each step below leaves its stamp only when it is complete.
.venv/.made: FORCE
	@tools/setup.sh venv

.venv/.tools: .venv/.made pyproject.toml constraints.txt
	@tools/setup.sh tools

.venv/.sources: .venv/.made FORCE
	@tools/setup.sh sources

ifneq ($(wildcard lib/botschool),)
.venv/.module: .venv/.tools .venv/.sources $(CPP_INPUTS)
	@tools/setup.sh module
else
.venv/.module: .venv/.made $(wildcard wheels/*.whl)
	@tools/setup.sh wheel
endif

.PRECIOUS: .venv/.extra-%
.venv/.extra-%: .venv/.module
	@tools/setup.sh extra $*

# BEGIN NOT RELEASED
.venv/.bench: .venv/.tests
	@tools/setup.sh bench

.venv/.pytest: .venv/.module
	@tools/setup.sh pytest

.venv/.tests: .venv/.pytest
	@tools/setup.sh tests
# END NOT RELEASED
