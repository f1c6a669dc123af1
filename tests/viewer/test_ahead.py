"""Work that is begun before anybody asks for it."""

import threading

import pytest

from add_viewer.tasks.ahead import Ahead


def test_what_is_asked_for_has_begun_already_and_is_computed_once():
    calls, begun = [], threading.Event()

    def work(text: str) -> str:
        calls.append(text)
        begun.set()
        return text.upper()

    ahead = Ahead(work, ["one"])
    assert begun.wait(10)
    assert (ahead("one"), ahead("two")) == ("ONE", "TWO")
    assert calls == ["one", "two"]


def test_a_second_question_reads_anew_because_the_file_may_have_changed():
    calls = []
    ahead = Ahead(calls.append, ["one"])
    ahead("one")
    ahead("one")
    assert calls == ["one", "one"]


def test_an_error_reaches_whoever_asks():
    def work(_text: str) -> None:
        raise ValueError("no such shape")

    with pytest.raises(ValueError, match="no such shape"):
        Ahead(work, ["one"])("one")
