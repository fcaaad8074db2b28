from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import app.evaluation

MODULES = sorted(module.name for module in pkgutil.iter_modules(app.evaluation.__path__))


@pytest.mark.parametrize("name", MODULES)
def test_the_examples_in_docstrings_are_true(name: str) -> None:
    assert doctest.testmod(importlib.import_module(f"app.evaluation.{name}")).failed == 0


def test_every_metric_has_an_example() -> None:
    attempted = {
        name: doctest.testmod(importlib.import_module(f"app.evaluation.{name}")).attempted
        for name in ("metrics", "average_precision", "official_v1_fixed")
    }
    assert attempted["metrics"] >= 13
    assert all(attempted.values())
