"""What a job's state reads like."""

from __future__ import annotations

from time import strftime, strptime

from .jobs import Job, State

STATE_WORDS: dict[State, str] = {
    "waiting": "Waiting for its turn",
    "running": "Running",
    "done": "Done",
    "failed": "Failed",
    "cancelled": "Cancelled",
    "paused": "Paused",
    "interrupted": "Interrupted",
}


def moment_of(job: Job) -> str:
    """When the job was asked for, as its folder's name tells: "28 Nov 11:38"."""
    try:
        return strftime("%d %b %H:%M", strptime(job.id[:15], "%Y%m%d-%H%M%S"))
    except ValueError:
        return job.id


def time_words(seconds: float) -> str:
    """A duration as precisely as anybody wants to know it."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 55:
        return f"{5 * round(seconds / 5):.0f} s"
    minutes = max(round(seconds / 60), 1)
    if minutes < 60:
        return f"{minutes} min"
    hours, rest = divmod(minutes, 60)
    return f"{hours} h {rest:02d} min" if hours < 24 else f"{hours // 24} d {hours % 24} h"


def headline(job: Job) -> str:
    """State, progress and time left in a few words: "Training, step 340 of 1,000 · 2 min left"."""
    if job.state == "running":
        words = [job.message or STATE_WORDS["running"]]
        if job.share is not None and not any(letter.isdigit() for letter in job.message):
            words.append(f"{job.done} of {job.total}")
        if job.seconds_left is not None:
            words.append(f"{time_words(job.seconds_left)} left")
        return " · ".join(words)
    stopped = job.state in ("paused", "interrupted") and job.share
    return STATE_WORDS[job.state] + (f" at {100 * job.share:.0f} %" if stopped and job.share else "")


def remark(job: Job) -> str:
    """What is worth a line of its own beside the headline: why it failed or stopped."""
    return job.message if job.state in ("failed", "interrupted") else ""
