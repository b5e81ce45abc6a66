"""Tables: columns of NumPy, for pandas and whatever reads Arrow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable

import numpy as np

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa


class Table:
    """Columns of the same length under their names, SI units in the names.

    Numbers and truth values are arrays of NumPy; names are kept as codes, as in a pandas.Categorical.
    """

    def __init__(self, columns: Iterable[tuple[Any, ...]]) -> None:
        """From (heading, array) and (heading, codes, names)."""
        self._columns = {heading: rest for heading, *rest in columns}

    @property
    def columns(self) -> list[str]:
        """Headings, in order."""
        return list(self._columns)

    def __len__(self) -> int:
        return next((len(column[0]) for column in self._columns.values()), 0)

    def __contains__(self, heading: object) -> bool:
        return heading in self._columns

    def __getitem__(self, heading: str) -> np.ndarray:
        """A column as an array; names as an array of texts."""
        array, *names = self._columns[heading]
        return np.array(names[0] or [""], dtype=object)[array] if names else array

    def __repr__(self) -> str:
        return f"<ambwhirl.Table of {len(self)} rows: {', '.join(self.columns)}>"

    def to_arrow(self) -> pa.Table:
        """As a pyarrow.Table. Numbers are not copied: it sees the same memory."""
        import pyarrow as pa

        def column(array, names=None):
            if names is None:
                return pa.array(array)
            return pa.DictionaryArray.from_arrays(pa.array(array), pa.array(names, pa.string()))

        return pa.table({heading: column(*rest) for heading, rest in self._columns.items()})

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """For whatever reads Arrow: Polars, DuckDB, pandas 3. Needs pyarrow."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> pd.DataFrame:
        """As a pandas.DataFrame."""
        import pandas as pd

        def column(array, names=None):
            return array if names is None else pd.Categorical.from_codes(array, names)

        return pd.DataFrame({heading: column(*rest) for heading, rest in self._columns.items()})
