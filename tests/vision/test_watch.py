"""Progress and cancelling, of Python code and of kernels."""

import ctypes

import pytest

from app.errors import Cancelled
from app.vision.native.library import CANCELLED, OUT_OF_MEMORY
from app.vision.watch import Watch


class OfTheCaller(Exception):
    """Raised by what the caller gave."""


def kernel_of(*shares: float, status: int = 7):
    """A kernel that reports these shares."""

    def kernel(argument: int, report) -> int:
        assert argument == 5
        for share in shares:
            if report and report(share):
                return CANCELLED
        return status

    return kernel


def test_a_part_tells_shares_of_the_whole() -> None:
    told: list[float] = []
    Watch(told.append).part(0.5, 1.0).part(0.0, 0.5).tell(0.5)
    assert told == [0.625]


def test_a_kernels_shares_are_passed_on() -> None:
    told: list[float] = []
    assert Watch(told.append).part(0.2, 0.4).call(kernel_of(0, 0.5, 1), 5) == 7
    assert told == pytest.approx([0.2, 0.3, 0.4])


def test_nobody_listens_then_the_kernel_gets_no_callback() -> None:
    def kernel(report) -> int:
        return 3 if not report else 0

    assert Watch().call(kernel) == 3


def test_a_wish_to_cancel_ends_a_kernel() -> None:
    answers = iter([False, True, True])
    told: list[float] = []
    with pytest.raises(Cancelled):
        Watch(told.append, lambda: next(answers)).call(kernel_of(0, 0.5, 1), 5)
    assert told == [0]


@pytest.mark.parametrize("error", [OfTheCaller("no"), KeyboardInterrupt()])
def test_what_the_caller_raises_comes_out_as_it_is(error: BaseException) -> None:
    def progress(share: float) -> None:
        if share > 0.4:
            raise error

    with pytest.raises(type(error)) as caught:
        Watch(progress).call(kernel_of(0, 0.5, 1), 5)
    assert caught.value is error


def test_a_kernel_without_memory_is_a_memory_error() -> None:
    with pytest.raises(MemoryError):
        Watch().call(kernel_of(status=OUT_OF_MEMORY), 5)


def test_the_callback_is_one_that_c_can_call() -> None:
    told: list[float] = []

    def kernel(report) -> int:
        called = ctypes.cast(report, ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_double))
        return called(0.25)

    assert Watch(told.append).call(kernel) == 0
    assert told == [0.25]
