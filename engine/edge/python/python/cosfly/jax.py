"""JAX: batches of ``jax.Array``. ``jax`` is imported when the first batch is made, not before."""

from __future__ import annotations

from typing import Any, Iterator

from ._dataset import Loader


def batches(loader: Loader) -> Iterator[Any]:
    """The batches of a :class:`cosfly.Loader` with ``jax.Array`` for arrays; texts stay as they are."""
    import jax.numpy as jnp

    for batch in loader:
        yield {name: jnp.asarray(value) if hasattr(value, "dtype") else value for name, value in batch.items()}
