"""Event files in Apache Parquet, by way of pyarrow."""

import base64
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.event_file.layout import COLUMNS, IMPULSE, KINDS, columns
from carom.event_file.source import Source, Span, refused

ABOUT, START = "carom", "carom.start."
#: Bytes of one value in the file's metadata: readers refuse those above 100 MB.
PIECE = 60_000_000
#: pyarrow's own limit is 100 MB for all metadata; the start of many millions of spheres is longer.
LIMIT = 2**31 - 1


def pyarrow(path: Path) -> Any:
    """Import pyarrow and its Parquet.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        msg = '.parquet needs pyarrow: pip install "carom[analysis]"; a name in .npz does without'
        raise InputError(msg) from error
    return pyarrow


class ParquetSink:
    """Writes one row group after the other."""

    def __init__(self, path: Path) -> None:
        self._arrow = arrow = pyarrow(path)
        # Now: where there is pandas this loads it, and at the end of a program that is too late.
        self._kinds = arrow.array(KINDS)
        kind = arrow.dictionary(arrow.int8(), arrow.string())
        plain = {"time": arrow.float64(), **dict.fromkeys(IMPULSE, arrow.float64())}
        types = {name: plain.get(name, arrow.int32()) for name in COLUMNS} | {"kind": kind}
        self._schema = arrow.schema(types.items())
        self._writer = arrow.parquet.ParquetWriter(
            path,
            self._schema,
            compression="snappy",
            use_dictionary=["kind", "wall"],
            # Bytes of like weight side by side, and small differences: a fifth smaller, no slower.
            column_encoding=dict.fromkeys(plain, "BYTE_STREAM_SPLIT")
            | dict.fromkeys(("i", "j"), "DELTA_BINARY_PACKED"),
        )

    def write(self, records: NDArray[Any]) -> None:
        """Add events."""
        written = columns(records)
        kind = self._arrow.DictionaryArray.from_arrays(written["kind"], self._kinds)
        table = self._arrow.table({**written, "kind": kind}, schema=self._schema)
        self._writer.write_table(table, row_group_size=len(records))

    def close(self, about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write what is known at the end, and the footer."""
        packed = io.BytesIO()
        np.savez_compressed(packed, **dict[str, Any](arrays))
        text = base64.b64encode(packed.getvalue()).decode()
        pieces = {f"{START}{k}": text[k : k + PIECE] for k in range(0, len(text), PIECE)}
        self._writer.add_key_value_metadata({ABOUT: json.dumps(about), **pieces})
        self._writer.close()


class ParquetSource(Source):
    """Reads a Parquet file."""

    def __init__(self, path: Path) -> None:
        arrow = pyarrow(path)
        try:
            self._file = arrow.parquet.ParquetFile(
                path, thrift_string_size_limit=LIMIT, thrift_container_size_limit=LIMIT
            )
        except arrow.ArrowInvalid as error:
            reason = "it is no Parquet, cut short, or not closed because its program was killed"
            raise refused(path, reason) from error
        about = self._file.metadata.metadata or {}
        if ABOUT.encode() not in about:
            raise refused(path, "this Parquet was not written by record_events()")
        self.about = json.loads(about[ABOUT.encode()])
        groups = range(self._file.metadata.num_row_groups)
        self.spans = [self._span(k) for k in groups]
        self._pieces = {
            int(key.removeprefix(START.encode())): piece
            for key, piece in about.items()
            if key.startswith(START.encode())
        }

    def _span(self, k: int) -> Span:
        group = self._file.metadata.row_group(k)
        times = group.column(COLUMNS.index("time")).statistics
        return Span(group.num_rows, times.min, times.max)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Where the run began."""
        text = b"".join(self._pieces[k] for k in sorted(self._pieces))
        with np.load(io.BytesIO(base64.b64decode(text)), allow_pickle=False) as file:
            return dict(file)

    def read(self, part: int, names: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Read columns of one row group."""
        table = self._file.read_row_group(part, columns=list(names))
        found = {name: table.column(name).combine_chunks() for name in names}
        return {
            name: (column.indices if name == "kind" else column).to_numpy(zero_copy_only=False)
            for name, column in found.items()
        }
