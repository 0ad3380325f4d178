# Two commands: `make report` (the main job) and `make test`. Both make .venv themselves.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
# What is compiled is kept, whatever the environment says: tests start a hundred processes that import all of it.
export PYTHONDONTWRITEBYTECODE :=
LEFT_OUT := compiler or browser or coq or slow or long
# Two to eight processes, as there are cores. A share of the files each, so that what a file shares is made once; who is
# done first takes from another.
CORES := $(shell n=$$(nproc 2>/dev/null || echo 2); echo $$((n < 2 ? 2 : n > 8 ? 8 : n)))
PYTEST := $(BIN)/python -m pytest -n $(CORES) --dist worksteal --quiet
# Rooms whose tests take about a minute on two cores, less the files that take ten seconds and more each; not derivations,
# pictures, commands, and papers but their engine.
LONG := io/test_io_foreign io/test_face_boundary io/test_io_cad judge/test_de_boor \
	judge/test_meets proof/test_squares blending/test_reduced blending/test_real_bases blending/test_units \
	blending/test_closed_pairs blending/test_blending blending/test_open_cascade_hundred
QUICK := tests/test_documents.py tests/test_readme.py tests/test_rooms.py tests/papers/ledger tests/papers/checks \
	tests/papers/latex tests/papers/pseudocode \
	$(addprefix tests/solver/,splines generated proof judge blending io c_export) \
	$(patsubst %,--ignore=tests/solver/%.py,$(LONG))

.PHONY: report check quick test test-left-out test-kernels mutants lint types layers fresh recheck coq bench shapes reach solids pictures clean

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[test,bench]'
	touch $@

report: $(STAMP)
	$(BIN)/semispline reproduce lin2014 --out build/report

test: $(STAMP)
	$(PYTEST) -m 'not ($(LEFT_OUT))'
	@echo "Left out here, run by .ci/run: tests marked compiler (a C compiler), browser (Chromium), coq (the kernel of Coq), slow (long sweeps) or long (half a second and more); and most examples of the sweeps"

# The loop while working.
check: lint types layers quick

quick: $(STAMP)
	$(PYTEST) -m 'not ($(LEFT_OUT))' $(QUICK)

# With all examples of the sweeps; `make coq` runs what needs Coq. pytest leaves with 5 when nothing carries these marks.
test-left-out: $(STAMP)
	SEMISPLINE_SWEEPS=whole $(PYTEST) -m '($(LEFT_OUT) or sweep or hypothesis) and not coq' || [ $$? -eq 5 ]

# Under each kernel of OpenBLAS that the processor has; KERNELS=another takes any one that is not the default.
test-kernels: $(STAMP)
	$(BIN)/python tests/kernels.py $(KERNELS)

# An hour or two that go on where they were interrupted; see tests/mutants/__init__.py.
mutants: $(STAMP)
	PYTHONPATH=tests PYTHONHASHSEED=0 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m mutants

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

layers: $(STAMP)
	$(BIN)/lint-imports --no-cache --no-logo

fresh: $(STAMP)
	$(BIN)/semispline generate --check

# What the verdicts rest on, repeated by PARI: in a process without SymPy, and by gp alone.
recheck: $(STAMP)
	$(BIN)/semispline verify lin2014 --recheck pari --certificates build/certificates
	cd build/certificates && gp -q check.gp

# The same by the kernel of Coq, with the theorems of derivations/coq from the definition of B-splines on; its controls.
coq: $(STAMP)
	$(PYTEST) -m coq

bench: $(STAMP)
	$(BIN)/python benchmarks/run.py

# Every pair of the families, judged: docs/shapes.md, and pictures in build/shapes. AGAIN=--resume goes on where it stopped,
# AGAIN=--tables makes table and pictures from what is there.
shapes: $(STAMP)
	$(BIN)/python benchmarks/shapes/run.py $(AGAIN)

# Every place of real files, blended by --replace: docs/reach.md. AGAIN as of shapes; MORE names further files.
reach: $(STAMP)
	$(BIN)/python benchmarks/reach/run.py $(AGAIN) $(MORE)

# Every fillet of real files, replaced by --replace, one solid back: docs/solids.md. AGAIN and MORE as of reach.
solids: $(STAMP)
	$(BIN)/python benchmarks/solids/run.py $(AGAIN) $(MORE)

# The picture in README, of the example beside it: docs/pipe_to_elbow.png.
pictures: $(STAMP)
	$(BIN)/python docs/pictures.py

clean:
	rm -rf $(VENV) build
