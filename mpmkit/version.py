"""The version of mpmkit that is installed."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("mpmkit")
except PackageNotFoundError:  # a checkout that is not installed
    __version__ = "0.0.0"
