#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packs the wheel of the Python package: contrib/python/crawler with the compiled part for this Python (PEP 427).

    wheel.py MODULE VERSION FOLDER

prints the name of the wheel. Ends with 1 if the module needs more than Python and the libraries of C.
"""
import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIBRARIES_OF_C = {"libc.so.6", "libm.so.6", "libmvec.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
METADATA = """Metadata-Version: 2.1
Name: crawler
Version: {version}
Summary: Finite elements for the one-dimensional limbless crawler: single runs, batches, sweeps, gradients and fits
License: LGPL-2.1-or-later
Requires-Python: =={python}.*
Requires-Dist: numpy
Requires-Dist: scipy; extra == "all"
Requires-Dist: pandas; extra == "all"
Requires-Dist: h5py; extra == "all"
Requires-Dist: matplotlib; extra == "all"
Provides-Extra: all
"""
WHEEL = """Wheel-Version: 1.0
Generator: crawler
Root-Is-Purelib: false
Tag: {tag}
"""
WHEN = (1980, 1, 1, 0, 0, 0)  # of all files, so that equal contents are equal wheels


def require_only_c(module):
    """Ends if the module needs other libraries, or functions that nothing defines."""
    needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", subprocess.run(
        ["readelf", "-dW", module], check=True, capture_output=True, text=True).stdout))
    symbols = subprocess.run(["nm", "-D", "--undefined-only", module], check=True, capture_output=True, text=True).stdout
    missing = [name for kind, name in re.findall(r"^\s+(\w) (\S+)$", symbols, re.MULTILINE)
               if kind == "U" and "@" not in name and not re.match("_?Py", name)]
    if needed - LIBRARIES_OF_C or missing:
        sys.exit(f"wheel.py: {module} needs {', '.join(sorted([*needed - LIBRARIES_OF_C, *missing]))}, which the wheel does not have")


def main():
    """Command line."""
    module, version, folder = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    require_only_c(module)
    python = "cp{}{}".format(*sys.version_info)
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    package = ROOT / "contrib/python/crawler"
    contents = {f"crawler/{path.relative_to(package)}": path.read_bytes() for path in sorted(package.rglob("*"))
                if path.is_file() and "__pycache__" not in path.parts}
    contents[f"crawler/{module.name}"] = module.read_bytes()
    info = f"crawler-{version}.dist-info"
    contents[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    contents[f"{info}/METADATA"] = METADATA.format(version=version, python="{}.{}".format(*sys.version_info)).encode()
    contents[f"{info}/WHEEL"] = WHEEL.format(tag=tag).encode()
    record = "".join(f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},{len(content)}\n"
                     for name, content in contents.items())
    contents[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    folder.mkdir(parents=True, exist_ok=True)
    name = folder / f"crawler-{version}-{tag}.whl"
    with zipfile.ZipFile(name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in contents.items():
            entry = zipfile.ZipInfo(path, WHEN)
            entry.external_attr = (0o755 if path.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
    print(name)


if __name__ == "__main__":
    main()
