# `make walk` shows a robot walking, `make test` checks everything, `make docs` builds the pages.
PYTHON ?= python3
BIN := .venv/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check

.PHONY: walk test docs schemas clean

walk: .venv/run.stamp
	$(BIN)/windup walk op3 --plot walk.png

test: .venv/dev.stamp .venv/clients.stamp
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/pytest -n 2

docs: .venv/docs.stamp
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet
	@echo "documentation: .venv/site/index.html"

# JSON Schemas of the TOML files; a test says when they are out of date.
schemas: .venv/run.stamp
	$(BIN)/python -m windup.tools.schemas.generate

.venv/bin/python:
	$(PYTHON) -m venv .venv

.venv/run.stamp: pyproject.toml | .venv/bin/python
	$(PIP) -e '.[plot]'
	@touch $@

.venv/dev.stamp: pyproject.toml | .venv/bin/python
	$(PIP) -e '.[dev]'
	@touch $@ .venv/run.stamp

.venv/docs.stamp: pyproject.toml | .venv/bin/python
	$(PIP) -e '.[docs]'
	@touch $@

# Clients for tests. They lie beside the environment: one has the import name of
# feetech-servo-sdk, LeRobot would bring torch, and pypot OpenCV.
.venv/clients.stamp: Makefile | .venv/bin/python
	$(PIP) --no-deps --upgrade --target .venv/ftservo ftservo-python-sdk==2.0.1
	$(PIP) --no-deps --upgrade --target .venv/pypot pypot==5.0.2
	$(PIP) --no-deps --upgrade --target .venv/lerobot \
	  lerobot==0.4.4 deepdiff==8.6.2 orderly-set==5.5.0 tqdm==4.70.1
	@touch $@

clean:
	rm -rf .venv
