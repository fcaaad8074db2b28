"""A function over many items in worker processes, where one item may fail, or kill its worker, without the others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from itertools import islice
from typing import Generic, TypeVar

from app.errors import ClearLinesError, Unavailable
from app.jobs.executor import end_executor, make_executor

IN_FLIGHT_PER_WORKER = 2
ATTEMPTS_ALONE = 2

Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Outcome(Generic[Item, Result]):
    """What became of one item: a result, or the reason why there is none."""

    item: Item
    result: Result | None
    error: ClearLinesError | None


def map_in_processes(
    task: Callable[[Item], Result],
    items: Iterable[Item],
    workers: int,
    *,
    executors: Callable[[int], Executor] = make_executor,
) -> Iterator[Outcome[Item, Result]]:
    """Yield the outcome of each item as it arrives, in any order.

    A worker that dies takes its pool with it, and nobody can tell which item did it: what was in flight runs again one
    at a time, and only an item that kills its worker while it is alone is given up.

    Args:
        task: A module-level function; errors of the tree become the item's outcome, any other is raised.
        items: Taken one by one as there is room.
        workers: Number of processes.
        executors: Makes an executor of so many workers; called again when one broke.
    """
    remaining = iter(items)
    while True:
        running: dict[Future[Result], Item] = {}
        suspects: list[Item] = []
        executor = executors(workers)
        try:
            yield from _until_broken(executor, task, remaining, running, suspects, IN_FLIGHT_PER_WORKER * workers)
        except BrokenExecutor:
            suspects += running.values()
        else:
            return
        finally:
            end_executor(executor)
        for item in suspects:
            yield _run_alone(task, item, executors)


def _until_broken(
    executor: Executor,
    task: Callable[[Item], Result],
    remaining: Iterator[Item],
    running: dict[Future[Result], Item],
    suspects: list[Item],
    room: int,
) -> Iterator[Outcome[Item, Result]]:
    """Keep the executor busy; when it breaks, what has no outcome is in `running` and `suspects`."""

    def send(count: int) -> None:
        for item in islice(remaining, count):
            try:
                running[executor.submit(task, item)] = item
            except BrokenExecutor:
                suspects.append(item)
                raise

    send(room)
    while running:
        done, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in done:
            outcome = _outcome(running[future], future)
            del running[future]
            yield outcome
        send(room - len(running))


def _run_alone(
    task: Callable[[Item], Result], item: Item, executors: Callable[[int], Executor]
) -> Outcome[Item, Result]:
    for _ in range(ATTEMPTS_ALONE):
        executor = executors(1)
        try:
            return _outcome(item, executor.submit(task, item))
        except BrokenExecutor:
            continue
        finally:
            end_executor(executor)
    error = Unavailable(
        "the process that worked on it was killed, again and again",
        hint="most often memory ran out: use fewer workers, or a smaller image",
    )
    return Outcome(item, None, error)


def _outcome(item: Item, future: Future[Result]) -> Outcome[Item, Result]:
    try:
        return Outcome(item, future.result(), None)
    except ClearLinesError as error:
        return Outcome(item, None, error)
