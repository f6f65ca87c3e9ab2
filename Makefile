# Set-up, demo and tests; everything happens in installer/bootstrap.py, which also runs
# where there is no make: python installer/bootstrap.py setup|demo|test|screenshots|translations
#
# After a change of the dependencies in pyproject.toml, the lock is written anew with:
#   uv pip compile --universal --python-version 3.11 --generate-hashes --extra dev \
#     pyproject.toml -o requirements.lock --no-header

PYTHON ?= python3

.PHONY: setup demo test screenshots translations

setup demo test screenshots translations:
	@$(PYTHON) installer/bootstrap.py $@
