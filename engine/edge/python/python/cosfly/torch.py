"""PyTorch: ``torch.utils.data.DataLoader`` takes :class:`cosfly.Dataset` as it is; here is a loader that resumes.

``torch`` is imported when :class:`Loader` is iterated, not before.
"""

from __future__ import annotations

from typing import Any, Iterator

from . import _dataset
from ._dataset import Dataset, collated


class Loader(_dataset.Loader):
    """Batches of tensors, made by worker processes of a ``torch.utils.data.DataLoader``.

    The order is that of :class:`cosfly.Loader` with the same options, whatever the number of ``workers`` (0: this process).
    ``state_dict()`` names the batch after the last one that was handed out; a loader with this state goes on there, to the
    sample, also in another process and with another number of workers. ``data_loader`` are options of the ``DataLoader``,
    such as ``pin_memory`` or ``prefetch_factor``.
    """

    def __init__(self, dataset: Dataset, batch_size: int = 1, *, workers: int = 0, data_loader: Any = None, **options: Any):
        super().__init__(dataset, batch_size, **options)
        self.workers, self.data_loader = workers, dict(data_loader or {})

    def __iter__(self) -> Iterator[Any]:
        import torch.utils.data as data

        order = self._order()
        left = [order[batch * self.batch_size :][: self.batch_size].tolist() for batch in range(self.batch, len(self))]
        batches: Any = data.DataLoader(
            self.dataset,  # type: ignore[arg-type]
            batch_sampler=left, num_workers=self.workers, collate_fn=tensors_of, **self.data_loader,
        )  # fmt: skip
        for batch in batches:
            self.batch += 1
            yield batch
        self.epoch, self.batch = self.epoch + 1, 0


def tensors_of(samples: Any) -> Any:
    """A batch of samples (``collate_fn`` of a ``DataLoader``): tensors for arrays and numbers, lists for texts."""
    return tensors(collated(samples))


def tensors(batch: Any) -> Any:
    """A batch with tensors instead of arrays; texts stay as they are. Unsigned numbers above 8 bits become int64."""
    import torch

    def tensor(value: Any) -> Any:
        kind = value.dtype.kind if hasattr(value, "dtype") else ""
        if kind == "u" and value.dtype.itemsize > 1:
            value = value.astype("int64")
        return torch.from_numpy(value) if kind and kind in "biuf" else value

    return {name: tensor(value) for name, value in batch.items()}
