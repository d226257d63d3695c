"""Libraries that only some parts need: imported if installed; if not, one line says how to install them."""

from __future__ import annotations

import importlib
import json
from importlib.metadata import PackageNotFoundError, distribution
from types import ModuleType
from urllib.parse import unquote, urlparse

from overreach.errors import MissingExtraError


def pip_line(extra: str) -> str:
    """Return the line that installs `extra` the way this copy was installed: from its folder, or by name."""
    try:
        origin = json.loads(distribution("overreach").read_text("direct_url.json") or "{}")
    except (PackageNotFoundError, ValueError):
        origin = {}
    url = urlparse(origin.get("url", ""))
    if url.scheme != "file" or "dir_info" not in origin:
        return f"pip install 'overreach[{extra}]'"
    editable = "-e " if origin["dir_info"].get("editable") else ""
    return f"pip install {editable}'{unquote(url.path)}[{extra}]'"


def require(module: str, extra: str, job: str) -> ModuleType:
    """Return `module`; raises MissingExtraError, with the pip line, where it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        if (error.name or "").partition(".")[0] != module.partition(".")[0]:
            raise
        raise MissingExtraError(f"{module} is not installed ({job} needs it): {pip_line(extra)}") from None
