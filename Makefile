# `make` alone lists what it can do. Everything is installed into .venv; system libraries come from apt where there is apt.

.DEFAULT_GOAL := help
.NOTPARALLEL: # apt and pip hold locks of their own
.PHONY: help run test check bench clean clean-all system virtual-screen

# Whether a window can be shown: a Mac always can, elsewhere there is an X or a Wayland display to name.
UNATTENDED := $(if $(DISPLAY)$(WAYLAND_DISPLAY)$(filter Darwin,$(shell uname)),,yes)

help: ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/make \1\t\2/' | expand -t 18

run: $(if $(UNATTENDED),virtual-screen) .venv/installed ## open the app on a shipped person (no display: write add-viewer.png)
ifeq ($(UNATTENDED),yes)
	@.ci/with-screen .venv/bin/add-viewer humans/0 --pick 6868 --screenshot add-viewer.png
	@echo "There is no display here, so this is what the window shows: $(CURDIR)/add-viewer.png"
else
	@.venv/bin/add-viewer humans/0
endif

test: check virtual-screen ## set everything up, check and test
	@.ci/with-screen .venv/bin/python -m pytest -n 2 --dist worksteal

check: .venv/installed ## lint, format, types, import directions
	@.venv/bin/ruff check .
	@.venv/bin/ruff format --check --quiet .
	@.venv/bin/mypy
	@.venv/bin/lint-imports --no-logo

# One BLAS thread per process, as the app uses them, on kernels that BLAS chooses for this machine by itself.
MEASURED := env -u OPENBLAS_CORETYPE -u OPENBLAS_L2_SIZE OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

bench: virtual-screen .venv/installed ## measure; prints tables, asserts nothing
	@for script in tests/benchmarks/bench_*.py; do \
	    echo; echo "== $$script"; \
	    .ci/with-screen $(MEASURED) .venv/bin/python $$script || exit 1; \
	done

clean: ## remove what the tools left behind, but not .venv
	@rm -rf build dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis add-viewer.png
	@find add_core add_viewer tests -name __pycache__ -type d -prune -exec rm -rf {} +

clean-all: clean ## remove .venv too
	@rm -rf .venv

system:
	@.ci/system

virtual-screen:
	@.ci/system --virtual-screen

# Done again when one of these changes. The system's own packages come first, but are no reason to install again.
.venv/installed: pyproject.toml constraints.txt .ci/environment | system
	@.ci/environment
