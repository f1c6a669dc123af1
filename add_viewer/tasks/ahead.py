"""Work that is begun before anybody asks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

Answer = TypeVar("Answer")


class Ahead(Generic[Answer]):
    """A function of one text whose first answers are computed at once, on a thread of their own.

    Whoever calls it with one of `texts` waits for that answer, or gets its error; later calls compute anew.
    """

    def __init__(self, work: Callable[[str], Answer], texts: Iterable[str]) -> None:
        self._work = work
        self._begun: dict[str, Future[Answer]] = {}
        with_one_thread = ThreadPoolExecutor(1, thread_name_prefix="ahead")
        for text in texts:
            self._begun[text] = with_one_thread.submit(work, text)
        with_one_thread.shutdown(wait=False)

    def __call__(self, text: str) -> Answer:
        begun = self._begun.pop(text, None)
        return self._work(text) if begun is None else begun.result()
