"""Processes that are forked from one that has computed already, as multiprocessing does on Linux."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import Chain

import frfit

F = np.linspace(4.0, 110.0, 12)

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")

# Far above what the calls take, far below what the test run may take: a child that hangs is caught.
PATIENCE_S = 120


def responses(factor: complex) -> np.ndarray:
    return frfit.respond(Chain(90).model(factor), F, load=0, sensors=[3])


def identified(factor: complex) -> np.ndarray:
    # More rows than are solved as a dense matrix, which takes no threads.
    chain = Chain(60)
    measured = frfit.respond(chain.model(factor), F[:4], load=0, sensors=[50])[:, 0]
    one = frfit.Measurement(F[:4], measured, row=50)
    found = frfit.identify(chain.model(1200.0), one, load=0, matrix="springs")
    return found.factor


SHARED = Chain(90).model(1000.0)


def of_the_shared_model(row: int) -> np.ndarray:
    return frfit.respond(SHARED, F, load=0, sensors=[row])


def refused(_: int) -> None:
    frfit.respond(SHARED, F, load=0, sensors=[1000])


def in_children(work, arguments):
    """What two forked children return; an error where they have not ended in time."""
    with multiprocessing.get_context("fork").Pool(2) as pool:
        return pool.map_async(work, arguments).get(timeout=PATIENCE_S)


@pytest.mark.parametrize("work", [responses, identified])
def test_a_forked_child_computes_what_its_parent_does(work):
    factors = [900 * (1 + 0.02j), 1100 * (1 + 0.04j)]
    expected = [work(factor) for factor in factors]
    for got, ours in zip(in_children(work, factors), expected, strict=True):
        np.testing.assert_array_equal(got, ours)
    # The parent goes on as before.
    np.testing.assert_array_equal(work(factors[0]), expected[0])


def test_a_child_uses_a_model_of_its_parent_and_hands_its_errors_back():
    expected = [of_the_shared_model(row) for row in (1, 50)]
    np.testing.assert_array_equal(in_children(of_the_shared_model, (1, 50)), expected)
    with pytest.raises(frfit.InputError, match="sensors: expected a row") as caught:
        in_children(refused, [0])
    assert caught.value.key == "sensors" and caught.value.found == "1000"


def test_a_child_that_is_forked_while_another_thread_computes_does_not_wait_for_it():
    """In a process of its own: it forks with work in progress, over and over."""
    script = """
import os, sys, threading, time
import numpy as np, frfit
sys.path.insert(0, sys.argv[1])
from conftest import Chain
F = np.linspace(4.0, 110.0, 12)
model = Chain(400).model(1000 * (1 + 0.02j))
call = lambda: frfit.respond(model, F, load=0, sensors=[3])
expected = call()
busy = True
def work():
    while busy:
        call()
threads = [threading.Thread(target=work) for _ in range(2)]
[thread.start() for thread in threads]
for _ in range(20):
    child = os.fork()
    if child == 0:
        os._exit(0 if np.array_equal(call(), expected) else 1)
    assert os.waitpid(child, 0)[1] == 0
busy = False
[thread.join() for thread in threads]
print("done")
"""
    run = [sys.executable, "-W", "ignore", "-c", script, os.path.dirname(__file__)]
    got = subprocess.run(run, capture_output=True, text=True, timeout=PATIENCE_S)
    assert got.stdout == "done\n", got.stderr


def test_calls_of_several_threads_do_not_wait_in_each_others_work():
    expected = of_the_shared_model(7)
    got: list[np.ndarray] = []
    threads = [threading.Thread(target=lambda: got.append(of_the_shared_model(7))) for _ in range(6)]
    for thread in threads:
        thread.start()
    end = time.monotonic() + PATIENCE_S
    for thread in threads:
        thread.join(timeout=max(0.0, end - time.monotonic()))
    assert len(got) == 6
    for one in got:
        np.testing.assert_array_equal(one, expected)
