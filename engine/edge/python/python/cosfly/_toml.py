"""Recipes as dictionaries, written as TOML."""

from __future__ import annotations

import json
import math
from typing import Any, Mapping

from ._errors import WrongType


def dumps(recipe: Mapping[str, Any]) -> str:
    """TOML text of a recipe: tables at the top level as sections, everything below inline."""
    plain = {key: value for key, value in recipe.items() if not isinstance(value, Mapping)}
    lines = [f"{_key(key)} = {value_text(value)}" for key, value in plain.items()]
    for key, table in recipe.items():
        if isinstance(table, Mapping):
            for name, value in table.items():
                if isinstance(value, Mapping):
                    lines.append(f"\n[{_key(key)}.{_key(name)}]")
                    lines += [f"{_key(k)} = {value_text(v)}" for k, v in value.items()]
                else:
                    raise WrongType(f"`{key}.{name}` must be a table, like stages.town = {{use = 'map'}}")
    return "\n".join(lines) + "\n"


def value_text(value: Any) -> str:
    """TOML text of a value. Arrays of numpy and paths are taken, too."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        return repr(value) if math.isfinite(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(it) for it in value) + "]"
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        # JSON's escapes of strings are TOML's; DEL alone must be escaped as well.
        return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    raise WrongType(f"a recipe cannot hold {value!r}: use numbers, texts, booleans, lists and dictionaries")


def _key(key: str) -> str:
    plain = key and all(letter.isascii() and (letter.isalnum() or letter in "-_") for letter in key)
    return key if plain else value_text(str(key))
