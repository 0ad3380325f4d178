# Two commands: `make report` (the main job) and `make test`. Both make .venv themselves.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
LEFT_OUT := compiler or browser or slow

.PHONY: report test test-left-out test-kernels mutants lint types fresh bench clean

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[test,bench]'
	touch $@

report: $(STAMP)
	$(BIN)/semispline reproduce lin2014 --out build/report

test: $(STAMP)
	$(BIN)/python -m pytest -n 2 --quiet -m 'not ($(LEFT_OUT))'
	@echo "Left out here, run by .ci/run: tests marked compiler (a C compiler), browser (Chromium) or slow (long sweeps):"
	@$(BIN)/python -m pytest --collect-only --quiet -m '$(LEFT_OUT)' 2>/dev/null | tail -n 1

# pytest leaves with 5 when nothing carries these marks.
test-left-out: $(STAMP)
	$(BIN)/python -m pytest -n 2 --quiet -m '$(LEFT_OUT)' || [ $$? -eq 5 ]

# Under each kernel of OpenBLAS that the processor has; KERNELS=another takes any one that is not the default.
test-kernels: $(STAMP)
	$(BIN)/python tests/kernels.py $(KERNELS)

# A night's work that goes on where it was interrupted; see tests/mutants/__init__.py.
mutants: $(STAMP)
	PYTHONPATH=tests PYTHONHASHSEED=0 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m mutants

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

fresh: $(STAMP)
	$(BIN)/semispline generate --check

bench: $(STAMP)
	$(BIN)/python benchmarks/run.py

clean:
	rm -rf $(VENV) build
