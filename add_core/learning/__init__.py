"""Learned descriptors: the networks of the paper, their training, and trained models. Needs torch."""

from ..io import shipped_models
from .architectures import Architecture, Network, build_network
from .inputs import InputRecipe
from .layers import ASF, FC, SC, ReLU, Softmax
from .losses import multinomial_loss, siamese_loss, soft_nearest_loss
from .model import Matches, Model, load_model
from .runs import train
from .settings import TrainingSettings
from .task import LearningTask
from .training_set import TrainingShape, places_of

__all__ = [
    "ASF",
    "FC",
    "SC",
    "Architecture",
    "InputRecipe",
    "LearningTask",
    "Matches",
    "Model",
    "Network",
    "ReLU",
    "Softmax",
    "TrainingSettings",
    "TrainingShape",
    "build_network",
    "load_model",
    "multinomial_loss",
    "places_of",
    "shipped_models",
    "siamese_loss",
    "soft_nearest_loss",
    "train",
]
