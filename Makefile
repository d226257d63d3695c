# make drive: drive the simulated robot. make test: everything that must hold. make venv: the environment alone.
# make reproduce: the paper's figures and the comparison, as report/report.html. make bench: what things cost.
# make faults: every fault of SAFETY.md as often as is promised, and its table anew (45 minutes). make soak: 5 minutes,
# or SOAK=1h, of driving while memory is looked at.
# make robots-check: 1,000 random streams for each robot, mode and seed, into build/robots.json (an hour).
# make pictures: the pictures of the documentation, anew.
# make mutate: whether a test fails for every small change of the gate (15 minutes; not part of make test).
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
comma := ,
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet

.PHONY: drive reproduce test venv lint types bench faults soak robots-check mutate pictures browser headline clean

drive: venv
	@$(BIN)/overreach drive || [ $$? -eq 130 ]  # Ctrl-C is how it ends

reproduce: $(VENV)/.ready-all
	$(BIN)/overreach reproduce --out report

venv: $(VENV)/.ready

# What measures time has the machine to itself; the others run side by side.
test: export OPENBLAS_NUM_THREADS = 1
test: $(VENV)/.ready-dev browser lint types
	$(BIN)/python -m pytest -q -n 3 --dist loadfile --no-loadscope-reorder -m "not real_time"
	$(BIN)/python -m pytest -q -m real_time

lint: $(VENV)/.ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.ready-dev
	$(BIN)/mypy

bench: $(VENV)/.ready-dev browser
	$(BIN)/overreach bench
	$(BIN)/python -m benchmarks

SEED ?= 1
SOAK ?= 5m

faults: $(VENV)/.ready-dev browser
	rm -rf build/reached
	$(BIN)/python -m pytest -q -n 2 --dist loadfile -m "fault and not real_time and not timed" --full --seed $(SEED)
	$(BIN)/python -m pytest -q -m "fault and (real_time or timed)" --full --seed $(SEED)
	$(BIN)/python -m tests.reached

soak: $(VENV)/.ready-dev browser
	$(BIN)/python -m tests.soak $(SOAK) build/soak.json

STREAMS ?= 1000

robots-check: $(VENV)/.ready-dev
	$(BIN)/python -m tests.robots_check $(STREAMS) build/robots.json

pictures: export PYTHONPATH = .
pictures: $(VENV)/.ready-dev browser
	$(BIN)/python docs/pictures.py
	$(BIN)/python docs/swings.py

mutate: $(VENV)/.ready-mutate
	$(BIN)/python -m tests.mutation

headline: reproduce
	$(BIN)/python docs/headline.py report

browser: $(VENV)/.ready-dev
	$(BIN)/python tests/browser/install.py

# Each brings what the ones before it bring, in one go.
define install
@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "overreach needs Python 3.11 or newer; choose one with: make PYTHON=python3.12"; exit 1; }
$(PYTHON) -m venv $(VENV)
$(PIP) install -c constraints.txt -e '$(1)'
@touch $(2:%=$(VENV)/%)
endef

$(VENV)/.ready: pyproject.toml constraints.txt
	$(call install,.[fast],.ready)

$(VENV)/.ready-all: pyproject.toml constraints.txt
	$(call install,.[all],.ready .ready-all)

$(VENV)/.ready-dev: pyproject.toml constraints.txt
	$(call install,.[all$(comma)dev],.ready .ready-all .ready-dev)

$(VENV)/.ready-mutate: pyproject.toml constraints.txt
	$(call install,.[all$(comma)dev$(comma)mutate],.ready .ready-all .ready-dev .ready-mutate)

clean:
	rm -rf $(VENV) dist build/reached report .pytest_cache .mypy_cache .ruff_cache .hypothesis
