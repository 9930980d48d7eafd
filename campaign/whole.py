"""Files that are there whole or not at all."""

import os
from pathlib import Path


def replace(path: Path, text: str) -> None:
    """Write aside, then rename."""
    aside = path.with_name(f".{path.name}.{os.getpid()}.partial")
    aside.write_text(text, encoding="utf-8", newline="")
    os.replace(aside, path)
