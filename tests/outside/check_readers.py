"""DuckDB, polars and `datasets` (streaming, too) read a dataset and agree on rows, flights and means.

    venv/bin/python tests/outside/check_readers.py DATASET_FOLDER [CACHE]

Each table prints one line. Exit code 0: all agree.
"""

import os
import sys
from pathlib import Path

os.environ.setdefault("HF_HUB_OFFLINE", "1")
os.environ.setdefault("HF_DATASETS_OFFLINE", "1")

import datasets
import duckdb
import polars
import pyarrow.dataset

datasets.disable_progress_bars()
folder, cache = Path(sys.argv[1]).resolve(), sys.argv[2] if len(sys.argv) > 2 else None
# A number of each table whose sum shows that the rows are the same ones, too.
SUMS = {"trajectories": "frames", "frames": "drone_x_m", "windows": "start_frame", "bodies": "frame", "objects": "instance", "pairs": "frames"}


def close(a, b):
    return a == b or abs(a - b) <= 1e-9 * max(abs(a), abs(b), 1)


for place in sorted((folder / "data").iterdir()):
    table, glob = place.name, str(place / "*.parquet")
    column = SUMS.get(table)
    columns = set(pyarrow.dataset.dataset(place, format="parquet").schema.names)
    assert column is None or column in columns, f"{table} has no column {column}"
    total = f"sum({column})" if column else "0"
    by_duckdb = duckdb.sql(f"select count(*), coalesce({total}, 0) from read_parquet('{glob}')").fetchall()[0]
    lazy = polars.scan_parquet(glob)
    picked = [polars.len(), polars.col(column).sum()] if column else [polars.len()]
    by_polars = lazy.select(picked).collect().row(0)
    assert by_duckdb[0] == by_polars[0] and (not column or close(by_duckdb[1], by_polars[1])), (table, by_duckdb, by_polars)
    rows = by_duckdb[0]
    if not rows:  # the config stays, and its stream has no rows
        streamed = datasets.load_dataset(str(folder), table, streaming=True, cache_dir=cache)
        assert all(list(part) == [] and set(part.column_names or ()) == columns for part in streamed.values()), table
    else:
        whole = datasets.load_dataset(str(folder), table, cache_dir=cache)
        streamed = datasets.load_dataset(str(folder), table, streaming=True, cache_dir=cache)
        assert sum(part.num_rows for part in whole.values()) == rows, f"datasets sees other rows of {table}"
        count, total = 0, 0
        for split, part in streamed.items():
            in_split = 0
            for row in part.remove_columns([name for name in columns if name == "preview"]):
                in_split, total = in_split + 1, total + (row[column] if column else 0)
            assert in_split == whole[split].num_rows, f"{table}/{split}: {in_split} rows streamed"
            count += in_split
        assert count == rows and (not column or close(total, by_duckdb[1])), (table, count, total, by_duckdb)
    print(f"ok  {table:<14} {rows} rows in DuckDB, polars, datasets and its stream", flush=True)

by_flight = "select trajectory_id, count(*) n from read_parquet('{0}/data/frames/*.parquet') group by 1 order by 1"
lengths = dict(duckdb.sql(by_flight.format(folder)).fetchall())
flights = polars.read_parquet(str(folder / "data/trajectories/*.parquet")).select("trajectory_id", "frames").rows()
assert lengths == dict(flights), "frames by flight differ from the table of flights"
print(f"check_readers: all agree on {len(lengths)} flights")
