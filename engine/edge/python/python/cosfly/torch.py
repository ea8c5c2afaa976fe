"""PyTorch: ``torch.utils.data.DataLoader`` takes :class:`cosfly.Dataset` as it is; here is the iterable style.

``torch`` is imported when :class:`Batches` is made, not before.
"""

from __future__ import annotations

from typing import Any, Iterator

from ._dataset import Dataset, Loader


def batches(dataset: Dataset, batch_size: int = 1, **options: Any) -> Any:
    """A ``torch.utils.data.IterableDataset`` of shuffled batches; workers of a DataLoader share every epoch.

    Use with ``DataLoader(..., batch_size=None)``. ``options`` are those of :class:`cosfly.Loader`.
    """
    import torch.utils.data as data

    class Batches(data.IterableDataset):  # type: ignore[misc, valid-type]
        """Shuffled batches of tensors."""

        def __init__(self) -> None:
            self.loader = Loader(dataset, batch_size, **options)

        def __iter__(self) -> Iterator[Any]:
            worker, loader = data.get_worker_info(), self.loader
            if worker is not None:
                rank, world = loader.shard
                shard = (rank * worker.num_workers + worker.id, world * worker.num_workers)
                loader = Loader(dataset, batch_size, **{**options, "shard": shard})
                loader.load_state_dict(self.loader.state_dict())
            return (tensors(batch) for batch in loader)

    return Batches()


def tensors(batch: Any) -> Any:
    """A batch with tensors instead of arrays; texts stay as they are."""
    import torch

    numbers = lambda it: hasattr(it, "dtype") and it.dtype.kind in "biuf" and it.dtype.name not in ("uint32", "uint64")
    return {
        name: torch.from_numpy(value) if numbers(value) else
        torch.from_numpy(value.astype("int64")) if hasattr(value, "dtype") and value.dtype.kind == "u" else value
        for name, value in batch.items()
    }  # fmt: skip
