# Everything runs in a virtual environment of the project's own; nothing needs to be installed beforehand but
# python3 (3.11 or newer), pip and make. Choose another interpreter with `make PYTHON=python3.13 …`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
# The peers that the benchmarks compare with have an environment to themselves.
BENCH ?= .venv-bench
# pip installs from outside, so that the environment needs no pip of its own (Debian ships venv without it).
PIP := $(PYTHON) -m pip --python $(BIN)/python --disable-pip-version-check

.PHONY: help demo test test-long explore fuzz check lint types notebooks docs diagrams reproduce bench clean

help:
	@echo "make demo       run the paper's line formation and say where the pictures are"
	@echo "make test       run the test suite, on the same examples each time"
	@echo "make test-long  run the tests that it leaves out as they take long"
	@echo "make explore    try the laws on new examples; MINUTES=10 by default"
	@echo "make fuzz       try mutated commands, and count what came of them; MINUTES=10 SEED=7 for others"
	@echo "make check      lint, types and tests"
	@echo "make notebooks  run the notebooks from top to bottom"
	@echo "make docs       build the documentation into out/docs/site; every warning is an error"
	@echo "make diagrams   export the pictures and schemas in diagrams/ anew"
	@echo "make reproduce  rerun the paper's study into out/paper"
	@echo "make bench      measure speed beside the peers, and write tests/benchmarks/README.md"
	@echo "make clean      remove the environment and all results"

demo: $(VENV)/installed
	$(BIN)/drake-formation run diagrams/line.yaml --out out/line

test: $(VENV)/installed-dev
	$(BIN)/python -m pytest --numprocesses auto --dist loadfile -m "not slow" $(PYTEST)

test-long: $(VENV)/installed-dev
	$(BIN)/python -m pytest --numprocesses auto --dist worksteal -m slow $(PYTEST)

explore: $(VENV)/installed-dev
	$(BIN)/python tests/explore.py $(or $(MINUTES),10) $(PYTEST)

# Mutated commands, new ones with each seed: make fuzz MINUTES=10 SEED=7. Without MINUTES, a fixed number of them.
SEED ?= 1
fuzz: $(VENV)/installed-dev
	cd tests && $(abspath $(BIN))/python -m fuzz --seed $(SEED) $(if $(MINUTES),--minutes $(MINUTES),--count 150)

check: lint types test

lint: $(VENV)/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/installed-dev
	$(BIN)/mypy

notebooks: $(VENV)/installed-dev
	$(BIN)/python -m pytest tests/notebooks $(PYTEST)

docs: $(VENV)/installed-dev
	$(BIN)/python docs/build.py

diagrams: $(VENV)/installed-dev
	for name in line quadrilateral octagon s_curve shared-medium; do \
		$(BIN)/drake-formation graphviz $$name -o diagrams/$$name.svg || exit; \
	done
	for kind in scenario sweep comparison; do \
		$(BIN)/drake-formation schema $$kind > diagrams/schema/$$kind.schema.json || exit; \
	done
	for name in delay lossy link-failure saturated switching crowded; do \
		$(BIN)/drake-formation run $$name --out out/$$name || exit; \
		cp out/$$name/figures/overview.png diagrams/$$name.png; \
	done
	$(BIN)/drake-formation graphviz octagon --view formation -o diagrams/octagon-formation.svg
	$(BIN)/drake-formation run line --out out/line
	cp out/line/figures/paths.png diagrams/line-paths.png
	$(BIN)/drake-formation run robot-failure --out out/robot-failure
	cp out/robot-failure/figures/paths.png diagrams/robot-failure.png
	$(BIN)/drake-formation reproduce --only fig11 --out out/paper
	cp out/paper/figures/fig11.png diagrams/paper-fig11.png
	$(BIN)/drake-formation reproduce --only bandwidth --out out/bandwidth
	cp out/bandwidth/figures/bandwidth.png diagrams/bandwidth.png
	$(BIN)/drake-formation sweep gains --out out/gains
	cp out/gains/figures/consensus_error_m.png diagrams/gains-consensus-error.png
	$(BIN)/drake-formation sweep bandwidth --out out/shared-bandwidth
	cp out/shared-bandwidth/figures/consensus_error_m.png diagrams/shared-bandwidth.png
	$(BIN)/drake-formation sweep resilience --out out/resilience
	cp out/resilience/figures/outside_tolerance_s.png diagrams/resilience.png
	$(BIN)/drake-formation compare avoidance --out out/avoidance
	cp out/avoidance/figures/paths.png diagrams/avoidance-paths.png
	$(BIN)/drake-formation analyze line --set consensus.delta=1e4 --out out/certificate
	cp out/certificate/figures/delay_margin.png diagrams/line-delay-margin.png
	$(BIN)/python tests/view_picture.py diagrams/view.png

reproduce: $(VENV)/installed
	$(BIN)/drake-formation reproduce --out out/paper

bench: $(BENCH)/installed
	cd tests/benchmarks && $(abspath $(BENCH))/bin/python report.py $(PARTS)

clean:
	rm -rf $(VENV) $(BENCH) out build dist .mypy_cache .pytest_cache .ruff_cache .hypothesis

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "$(PYTHON) is older than 3.11; give a newer one: make PYTHON=python3.12 …"; exit 1; }
	$(PYTHON) -m venv --without-pip $(VENV)

$(VENV)/installed: pyproject.toml | $(BIN)/python
	$(PIP) install --quiet --editable .
	@touch $@

$(VENV)/installed-dev: pyproject.toml | $(BIN)/python
	$(PIP) install --quiet --editable '.[dev]'
	@touch $@ $(VENV)/installed

$(BENCH)/installed: pyproject.toml tests/benchmarks/requirements.txt
	$(PYTHON) -m venv --without-pip $(BENCH)
	$(PYTHON) -m pip --python $(BENCH)/bin/python --disable-pip-version-check install --quiet \
		--editable . --requirement tests/benchmarks/requirements.txt
	@touch $@
