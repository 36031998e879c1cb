# Everything a reader of the README needs. Each step does its own parallel work, so steps run one at a time even
# under `make -j`.
.NOTPARALLEL:
.DEFAULT_GOAL := help

LEVEL ?= gate
BUILD := build
JOBS ?= $(shell nproc)
PYTHON := .venv/bin/python
# Flags for the first configuration, or for changing it: make build CMAKE_FLAGS=-DSLURRY_ARCHITECTURE=x86-64-v3
CMAKE_FLAGS ?=

.PHONY: help setup configure build test test-kill reference verify stability report faults mutations claims baseline bench bench-peers bands ablation operators transients counts figures plot movie test-slurm lint sanitize fuzz flows format docs clean

help: ## List the targets
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 20

setup: ## Install what is missing: Debian packages (packages.apt) and .venv (requirements.txt)
	@scripts/setup

configure: setup
	@if [ -n "$(CMAKE_FLAGS)" ] || [ ! -e $(BUILD)/CMakeFiles/TargetDirectories.txt ]; then \
	    [ -e $(BUILD)/CMakeCache.txt ] || ! command -v ninja >/dev/null || generator=-GNinja; \
	    cmake -S . -B $(BUILD) $${generator:-} $(CMAKE_FLAGS); fi

build: configure ## Build build/slurry and its tests
	@env -u MAKEFLAGS -u MFLAGS cmake --build $(BUILD) --parallel $(JOBS)

figures: build ## Sweeps, ensembles and their figures (build/figures), on all cores; resumes (LEVEL=gate or paper)
	@$(PYTHON) -m verification.workflow --level $(LEVEL) --cores $(JOBS)
	@env -u MAKEFLAGS -u MFLAGS $(PYTHON) -m snakemake --profile verification/profiles/local --cores $(JOBS) \
	    --config level=$(LEVEL)

plot: setup ## Pictures of a run into RUN/plots: make plot RUN=FOLDER, the folder that `slurry run` wrote
	@$(PYTHON) -m verification.plot $(if $(RUN),"$(RUN)")

FIELD ?= vorticity
movie: setup ## A movie of a run with snapshots: make movie RUN=FOLDER FIELD=vorticity, pressure or speed
	@$(PYTHON) -m verification.movie $(if $(RUN),"$(RUN)") --field $(FIELD)

test-slurm: build ## A small ensemble through a Slurm cluster of this machine alone; skipped where that cannot run
	@scripts/test_slurm

test: build ## Unit tests: GoogleTest through ctest, then pytest
	@ctest --test-dir $(BUILD) --parallel $(JOBS) --output-on-failure --no-tests=error
	@OMP_WAIT_POLICY=passive $(PYTHON) -m pytest --numprocesses=$(JOBS) --dist=loadfile tests/python

test-kill: build ## Kill a run with SIGKILL at 50 random moments, resume it, and compare every bit
	@$(PYTHON) -m pytest tests/python/test_resume.py -k killed --kills 50

reference: setup ## Make the reference solutions that verify compares with (cached in build/reference)
	@$(PYTHON) -m reference.make

verify: build ## Run every case against its reference; the exit status is the verdict (LEVEL=gate or paper)
	@$(PYTHON) -m verification.run --level $(LEVEL)

stability: build ## Push every hard case until it breaks: margins in build/stability/report.html (half an hour; resumes)
	@$(PYTHON) -m verification.stability --jobs $(JOBS) --page verification/stability/README.md

report: setup ## Write the report again from the last results (build/verify/report.html)
	@$(PYTHON) -m verification.report

faults: build ## Plant each known fault and show that the named checks fail
	@$(PYTHON) -m verification.faults --page verification/faults.md

mutations: build ## Plant small faults in the physics by machine; at least 90 % must be caught (about an hour; resumes)
	@$(PYTHON) -m verification.mutations --page verification/mutations.md

claims: setup ## Write verification/claims.md, the ledger of the paper's claims, and F_tau's tables, from the last results
	@$(PYTHON) -m verification.claims

baseline: setup ## Accept the last results as verification/baseline.json, for review in a commit
	@$(PYTHON) -m verification.baseline --accept

bench: build ## Speed against error and the speed targets (build/bench, speed.md); leave the machine alone meanwhile
	@$(PYTHON) -m verification.bench --page verification/speed.md

bench-peers: build ## PySPH (installed when missing) on flows of ours beside our solver (report of bench, speed.md)
	@scripts/setup python3-pysph
	@$(PYTHON) -m verification.bench.peers --page verification/speed.md

bands: build ## Hold the bands of `slurry converge` against flows with a known truth (build/converge, accuracy.md)
	@$(PYTHON) -m verification.converge --page verification/accuracy.md

ablation: build ## Errors with one key changed at a time: the table of verification/accuracy.md
	@$(PYTHON) -m verification.ablation

operators: build ## Errors of the sums over pairs on the exact field: other tables of verification/accuracy.md
	@$(PYTHON) -m verification.operators

transients: build ## From when on a steady answer may be read, by how it starts: a table of verification/accuracy.md
	@$(PYTHON) -m verification.transients

counts: setup ## Instructions of a step (valgrind) against verification/counts.json; the exit status is the verdict
	@env -u MAKEFLAGS -u MFLAGS $(PYTHON) -m verification.counts --jobs $(JOBS)

sanitize: setup ## Unit tests and short scenes under the address, undefined-behaviour and thread sanitizers (clang)
	@env -u MAKEFLAGS -u MFLAGS scripts/sanitize $(JOBS)

RUNS ?= 1000000
fuzz: setup ## RUNS executions of each fuzzer (clang's libFuzzer) on the readers of scenes, CSV files and checkpoints
	@env -u MAKEFLAGS -u MFLAGS scripts/fuzz $(JOBS) $(RUNS)

FLOWS ?= 1000
flows: build ## FLOWS random scenes, each of which has to run or be refused with a reason
	@SLURRY_FLOWS=$(FLOWS) $(BUILD)/slurry_tests --gtest_filter='RandomFlows.*'

lint: configure ## Check format, clang-tidy, cppcheck and ruff
	@scripts/lint $(BUILD) $(JOBS)

format: setup ## Rewrite C++ and Python files in the house's format
	@find solver tests \( -name '*.cpp' -o -name '*.hpp' \) -print0 | xargs -0 clang-format -i
	@$(PYTHON) -m ruff check --fix-only --quiet .
	@$(PYTHON) -m ruff format .

docs: build ## Write docs/scene.md, and from the last results README's table and the pictures in docs/
	@mkdir -p docs
	@$(BUILD)/slurry help scene --markdown >$(BUILD)/scene.md
	@mv $(BUILD)/scene.md docs/scene.md
	@[ ! -e $(BUILD)/verify/results.json ] || \
	    $(PYTHON) -m verification.report --readme README.md --picture docs/rough_channel.png
	@[ ! -e $(BUILD)/verify/figures/disc_pair_snapshots.png ] || \
	    cp $(BUILD)/verify/figures/disc_pair_snapshots.png docs/disc_pair.png

clean: ## Remove build/ (also the cached references and the last results)
	rm -rf $(BUILD)
