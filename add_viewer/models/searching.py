"""Finding one of many by a few letters: "cas" finds "Copy as script", "alpha" finds "α"."""

from __future__ import annotations

import re
import unicodedata

_GREEK = {"α": "alpha", "β": "beta", "θ": "theta", "λ": "lambda", "φ": "phi", "κ": "kappa", "σ": "sigma"}
_WHOLE, _START, _INSIDE, _INITIALS, _SCATTERED = 100.0, 80.0, 50.0, 40.0, 15.0


def match_score(query: str, text: str) -> float | None:
    """How well `text` answers `query`: the more the better, None if some word of the query is not in it at all.

    Words may come in any order. Each counts most as a whole word, then as the start of one, inside one, as initials,
    and least as letters scattered in their order. Case, accents and the way Greek letters are written do not matter.
    """
    folded = fold(text)
    scores = [_word_score(word, folded) for word in fold(query).split()]
    if any(score is None for score in scores):
        return None
    return sum(score for score in scores if score is not None) - 0.05 * len(folded)


def fold(text: str) -> str:
    """Lower case, without accents, Greek letters spelled out: "Play θ" is "play theta"."""
    plain = "".join(letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter))
    return "".join(_GREEK.get(letter, letter) for letter in plain.lower())


def _word_score(word: str, text: str) -> float | None:
    at = re.search(rf"\b{re.escape(word)}", text)
    if at is not None:
        ends = at.end() == len(text) or not text[at.end()].isalnum()
        return (_WHOLE if ends else _START) - 0.1 * at.start()
    if word in text:
        return _INSIDE - 0.1 * text.index(word)
    initials = "".join(part[0] for part in re.findall(r"\w+", text))
    if word in initials:
        return _INITIALS
    spread = _spread(word, text)
    return None if spread is None or spread > 3 * len(word) else _SCATTERED - spread / len(word)


def _spread(word: str, text: str) -> int | None:
    """Over how many letters those of `word` are scattered in `text`, None if they are not there in this order."""
    first = at = -1
    for letter in word:
        at = text.find(letter, at + 1)
        if at < 0:
            return None
        first = at if first < 0 else first
    return at - first + 1
