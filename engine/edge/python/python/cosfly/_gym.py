"""Registers the environments of :mod:`cosfly.gym`; gymnasium calls this where the package is installed."""

ID = "cosfly/Track-v0"


def register() -> None:
    """Registers `cosfly/Track-v0`, once."""
    from gymnasium.envs.registration import register, registry

    if ID not in registry:
        register(id=ID, entry_point="cosfly.gym:Track", vector_entry_point="cosfly.gym:TrackVector")
