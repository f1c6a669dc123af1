"""Pictures of shapes without a window: colours that mean something everywhere, in the app and in figures."""
