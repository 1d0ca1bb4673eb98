#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packs the wheel of the Python package: contrib/python/crawler with the compiled part for this Python (PEP 427).

    wheel.py MODULE VERSION FOLDER

prints the name of the wheel, which also holds muParser and what it needs, and Chart.js, with their licences. Ends with 1 if the module
needs more than these, Python and the libraries of C and C++.
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
sys.path.insert(0, str(ROOT / "contrib/python/crawler"))
from needs import CHART_LIBRARIES, chart_library  # noqa: E402
COMMON = pathlib.Path("/usr/share/common-licenses")
# Libraries of the system, and those that the wheel brings, with files that have their licences.
SYSTEM = {"libc.so.6", "libm.so.6", "libmvec.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1", "libstdc++.so.6", "libgcc_s.so.1"}
BUNDLED = {"libmuparser.so.2": [pathlib.Path("/usr/share/doc/libmuparser2v5/copyright"), pathlib.Path("/usr/include/muParser.h")],
           "libgomp.so.1": [pathlib.Path("/usr/share/doc/libgomp1/copyright"), COMMON / "GPL-3"],
           CHART_LIBRARIES[0].name: [pathlib.Path("/usr/share/doc/libjs-chart.js/copyright")]}
METADATA = """Metadata-Version: 2.1
Name: crawler
Version: {version}
Summary: Finite elements for the one-dimensional limbless crawler: single runs, batches, sweeps, gradients and fits
License: LGPL-2.1-or-later; crawler.libs: BSD-2-Clause (muParser), GPL-3.0-or-later WITH GCC-exception-3.1 (libgomp), MIT (Chart.js)
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


def output_of(*words):
    """What a command prints."""
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def symbols_of(library, which):
    """Pairs of kind and name of the dynamic symbols of a library; which: --undefined-only, --defined-only."""
    return re.findall(r"^[0-9a-f]*\s+(\w) (\S+)$", output_of("nm", "-D", which, library), re.MULTILINE)


def bundled_libraries(module):
    """Files of the libraries that the wheel brings, by name. Ends if the module needs others, or functions that nothing
    defines."""
    places = dict(re.findall(r"(\S+) => (/\S+)", output_of("ldd", module)))
    bundled, waiting, other = {}, [module], set()
    while waiting:
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", output_of("readelf", "-dW", waiting.pop()))) - SYSTEM - {*bundled}
        other |= needed - {*BUNDLED}
        for name in sorted(needed & {*BUNDLED}):
            bundled[name] = pathlib.Path(places[name])
            waiting.append(bundled[name])
    defined = {name for library in bundled.values() for _, name in symbols_of(library, "--defined-only")}
    other |= {name for kind, name in symbols_of(module, "--undefined-only")
              if kind == "U" and "@" not in name and not re.match("_?Py", name) and name not in defined}
    if other:
        sys.exit(f"wheel.py: {module} needs {', '.join(sorted(other))}, which the wheel does not have")
    return bundled


def licence(name):
    """The licence of a bundled library: texts, of a header its first comment."""
    texts = [path.read_text(encoding="utf-8") for path in BUNDLED[name]]
    return "\n\n".join(text[:text.index("*/") + 2] if path.suffix == ".h" else text for path, text in zip(BUNDLED[name], texts))


def main():
    """Command line."""
    module, version, folder = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    bundled = bundled_libraries(module)
    python = "cp{}{}".format(*sys.version_info)
    tag = f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"
    package = ROOT / "contrib/python/crawler"
    contents = {f"crawler/{path.relative_to(package)}": path.read_bytes() for path in sorted(package.rglob("*"))
                if path.is_file() and "__pycache__" not in path.parts}
    contents[f"crawler/{module.name}"] = module.read_bytes()
    info = f"crawler-{version}.dist-info"
    contents[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    libraries = {**{name: library.read_bytes() for name, library in bundled.items()}, CHART_LIBRARIES[0].name: chart_library().encode()}
    for name, library in libraries.items():
        contents[f"crawler.libs/{name}"] = library
        contents[f"{info}/licenses/{name}.txt"] = (
            f"{name} is Debian's, unchanged; its source code: https://sources.debian.org (packages muparser, gcc-12, node-chart.js).\n\n{licence(name)}").encode()
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
            entry.external_attr = (0o755 if ".so" in pathlib.Path(path).name and not path.endswith(".txt") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
    print(name)


if __name__ == "__main__":
    main()
