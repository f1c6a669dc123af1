"""Jobs on disk: each in a folder of its own, so that they outlive the window."""

from __future__ import annotations

import json
import logging
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from ..models.jobs import Job, JobRequest
from .data_folder import data_folder
from .exporting import write_atomically

FORMAT = 1
JOB_FILE, OUTPUT, LOG = "job.json", "output.jsonl", "log.txt"
STARTED = "Started on "
LOG_BYTES = 1 << 16

_log = logging.getLogger(__name__)


def default_home() -> Path:
    """Where jobs live."""
    return data_folder() / "jobs"


@dataclass(frozen=True)
class Stamp:
    """A process: its number, and when it began. pid 0 stands for none."""

    pid: int = 0
    began: str = ""

    @classmethod
    def of(cls, identity: Any) -> Stamp:
        """The stamp of whatever has `pid` and `began`."""
        return cls(identity.pid, identity.began)


@dataclass(frozen=True)
class KeptJob:
    """A job as its folder tells it. process : runs or ran it. window : started it."""

    job: Job
    process: Stamp = Stamp()
    window: Stamp = Stamp()


def keep(kept: KeptJob) -> None:
    """Write a job to its folder, whole or not at all. Raises OSError."""
    job, request = kept.job, kept.job.request
    content = {
        "format": FORMAT,
        "kind": request.kind,
        "title": request.title,
        "arguments": list(request.arguments),
        "resumable": request.resumable,
        "state": job.state,
        "done": job.done,
        "total": job.total,
        "message": job.message,
        "result": dict(job.result),
        "hidden": job.hidden,
        "process": [kept.process.pid, kept.process.began],
        "window": [kept.window.pid, kept.window.began],
    }
    request.folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(content, indent=1)

    def write(path: Path) -> None:
        path.write_text(text, encoding="utf-8")

    write_atomically(request.folder / JOB_FILE, write)


def kept_jobs(home: Path) -> list[KeptJob]:
    """What the folders in `home` hold, oldest first; those that cannot be read are left alone."""
    if not home.is_dir():
        return []
    folders = [each for each in sorted(home.iterdir()) if (each / JOB_FILE).is_file() and each.name[0] != "."]
    found = [_read(folder) for folder in folders]
    return [kept for kept in found if kept is not None]


def _read(folder: Path) -> KeptJob | None:
    try:
        content: dict[str, Any] = json.loads((folder / JOB_FILE).read_text(encoding="utf-8"))
        if content["format"] != FORMAT:
            raise ValueError(f"format {content['format']}")
        arguments = tuple(str(argument) for argument in content["arguments"])
        request = JobRequest(content["kind"], content["title"], arguments, folder, bool(content["resumable"]))
        progress = {name: content[name] for name in ("state", "done", "total", "message", "result", "hidden")}
        return KeptJob(Job(folder.name, request, **progress), Stamp(*content["process"]), Stamp(*content["window"]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        _log.warning("%s is left alone: it holds no job that can be read (%s).", folder, error)
        return None


def forget(folder: Path) -> None:
    """Delete a job with all that it wrote."""
    shutil.rmtree(folder, ignore_errors=True)


def log_of(folder: Path) -> str:
    """What the job's command said, as a person reads it: its end, if it is long.

    Run by run: when it started, its results, then what it complained about.
    """
    outputs = _runs(_last_lines(folder / OUTPUT), lambda line: not line)
    logs = _runs(_last_lines(folder / LOG), lambda line: line.startswith(STARTED))
    lines: list[str] = []
    silent: list[str] = []
    for output, log in reversed([*zip_longest(reversed(outputs), reversed(logs), fillvalue=silent)]):
        head = 1 if log and log[0].startswith(STARTED) else 0
        lines += [*log[:head], *output, *log[head:]]
    return "\n".join(text for line in lines if (text := _readable(line)))


def _runs(lines: list[str], begins: Callable[[str], bool]) -> list[list[str]]:
    """The lines of each run of a command that was paused and went on."""
    runs: list[list[str]] = []
    for line in lines:
        if begins(line) or not runs:
            runs.append([])
        runs[-1].append(line)
    return runs


def _last_lines(path: Path) -> list[str]:
    try:
        with path.open("rb") as file:
            file.seek(max(0, path.stat().st_size - LOG_BYTES))
            return file.read().decode("utf-8", errors="replace").splitlines()
    except OSError:
        return []


def _readable(line: str) -> str:
    try:
        event = json.loads(line)
    except ValueError:
        return line.rstrip()
    if not isinstance(event, dict) or event.get("event") in ("progress", "step", "prepare"):
        return ""
    kind = event.pop("event", "")
    known = {name: value for name, value in event.items() if value is not None and not isinstance(value, bool)}
    facts = ", ".join(
        f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in known.items()
    )
    return f"{kind}: {facts}" + (", the best so far" if event.get("improved") else "")
