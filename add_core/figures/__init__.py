"""The paper's figures, drawn anew from the shipped shapes. Needs matplotlib."""

from .gallery import FIGURES, PaperFigure
from .quality import QUALITIES, Quality
from .reproduction import FORMATS, Outcome, reproduce

__all__ = ["FIGURES", "FORMATS", "QUALITIES", "Outcome", "PaperFigure", "Quality", "reproduce"]
