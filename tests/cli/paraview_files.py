#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the files of a run the way ParaView does, with VTK's own readers and filters, and checks what they hold.

    python3 paraview_files.py PATH_TO_CRAWLER          needs python3-vtk9 and mpirun

The same scene is run on one rank and on two; both must give the same fields.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

try:
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as error:
    sys.exit(f"{error}; the Debian package python3-vtk9 is expected (and /usr/bin/python3)")

# The points of the VTU files are then every fourth of the 201 points of the kymograph, and frames are every 16th row.
LENGTH, END_TIME, FRAMES, CELLS, DEGREE = 2.0, 1.5, 8, 10, 5
SCENE = f"""
subsection Body
  set Length = {LENGTH}
end
subsection Active stress
  subsection Optimal wave
    set Choose wave by = wave speed
  end
end
subsection Discretization
  set Degree = {DEGREE}
  set Number of cells = {CELLS}
  set Share cells = yes
end
subsection Time
  set End time = {END_TIME}
  set Tolerance = 1e-8
end
subsection Output
  set Number of snapshots = {FRAMES}
end
"""
FIELDS = {"displacement": 3, "position": 1, "stretch": 1, "velocity": 1, "active_stress": 1, "elastic_stress": 1,
          "friction_force": 1}
SINGLE = 1.2e-7  # relative resolution of single precision
NINE_DIGITS = 1e-8

failures = []


def check(condition, what):
    """Notes a failure and goes on."""
    if not condition:
        failures.append(what)
        print(f"FAILED: {what}")


def close(found, wanted, tolerance):
    """Whether all values agree within the tolerance times the largest, at least 1."""
    found, wanted = np.asarray(found, dtype=float), np.asarray(wanted, dtype=float)
    return found.shape == wanted.shape and np.abs(found - wanted).max() <= tolerance * max(1.0, np.abs(wanted).max())


def run(folder, name, command):
    """Runs the scene into a folder of this name."""
    file, output = folder / "scene.prm", folder / name
    file.write_text(SCENE)
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    try:
        done = subprocess.run([*command, "run", str(file), "--quiet", "--output", str(output)], env=environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    except (OSError, subprocess.TimeoutExpired) as problem:
        sys.exit(f"{name}: {problem}")
    if done.returncode != 0:
        sys.exit(f"{name}: exits with {done.returncode}: {done.stderr[-2000:]}")
    return output


def read(reader, path):
    """The data set in a file."""
    reader.SetFileName(str(path))
    reader.Update()
    if reader.GetErrorCode() != 0 or reader.GetOutput().GetNumberOfPoints() == 0:
        sys.exit(f"VTK cannot read {path}")
    return reader.GetOutput()


def point_data(data, name):
    """Point data of this name, as it is stored."""
    array = data.GetPointData().GetArray(name)
    if array is None:
        sys.exit(f"no point data {name}")
    return vtk_to_numpy(array)


def check_frame(name, data, time):
    """Everything that one VTU file must hold; returns its fields, ordered along the body."""
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    s = points[:, 0]
    fields = {field: point_data(data, field) for field in FIELDS}
    for field, components in FIELDS.items():
        check(fields[field].size == components * len(s), f"{name}: {field} has {components} component(s)")
        check(np.isfinite(fields[field]).all(), f"{name}: {field} is finite")
    check(data.GetPointData().GetNumberOfArrays() == len(FIELDS), f"{name}: no other fields")
    check(data.GetNumberOfCells() == CELLS * DEGREE, f"{name}: number of line segments")
    check(s.min() == 0 and abs(s.max() - LENGTH) < SINGLE * LENGTH and not points[:, 1:].any(),
          f"{name}: points from 0 to L")

    stored = data.GetFieldData().GetArray("TIME")
    check(stored is not None and abs(stored.GetValue(0) - time) <= SINGLE * END_TIME, f"{name}: TIME is {time}")

    position, stretch = fields["position"].astype(float), fields["stretch"].astype(float)
    check(not fields["displacement"][:, 1:].any(), f"{name}: displacement is along x")
    check(close(position, s + fields["displacement"][:, 0], 2 * SINGLE), f"{name}: position = s + displacement")
    check(close(fields["elastic_stress"], stretch - 1, 2 * SINGLE), f"{name}: elastic stress k (stretch - 1), k = 1")
    check(close(fields["friction_force"] * stretch, fields["velocity"], 4 * SINGLE),
          f"{name}: friction is velocity/stretch, a = -1")

    ends = np.array([[data.GetCell(i).GetPointId(j) for j in (0, 1)] for i in range(data.GetNumberOfCells())])
    slope = np.diff(position[ends], axis=1)[:, 0] / np.diff(s[ends], axis=1)[:, 0]
    check(np.allclose(slope, stretch[ends].mean(axis=1), rtol=0.03), f"{name}: stretch is the slope of the position")

    warp = vtk.vtkWarpVector()
    warp.SetInputData(data)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.Update()
    warped = vtk_to_numpy(warp.GetOutput().GetPoints().GetData())
    check(close(warped[:, 0], position, 2 * SINGLE) and not warped[:, 1:].any(),
          f"{name}: Warp By Vector gives the position")

    order = np.argsort(s[ends].mean(axis=1))
    along = ends[order].ravel()
    return {"s": s[along], **{field: values[along].astype(float) for field, values in fields.items()}}


def check_run(name, output):
    """All files of a run; returns the fields of every frame and of the kymograph."""
    datasets = ElementTree.parse(output / "solution.pvd").getroot().findall("Collection/DataSet")
    times = [END_TIME * i / FRAMES for i in range(FRAMES + 1)]
    check(close([float(d.get("timestep")) for d in datasets], times, 1e-9), f"{name}: times of the frames")
    check({d.get("file") for d in datasets} == {f"solution/{f.name}" for f in (output / "solution").iterdir()},
          f"{name}: solution.pvd lists the files that exist")
    files = [output / d.get("file") for d in datasets]
    frames = [check_frame(f"{name}, {file.name}", read(vtk.vtkXMLUnstructuredGridReader(), file), time)
              for file, time in zip(files, times)]

    check(not frames[0]["displacement"].any(), f"{name}: starts at rest")
    last, summary = frames[-1], json.loads((output / "summary.json").read_text())
    moved = np.trapz(last["displacement"][:, 0], last["s"]) / LENGTH
    check(abs(moved / summary["displacement"] - 1) < 1e-3,
          f"{name}: the last frame has moved as far as summary.json says")

    grid = read(vtk.vtkXMLStructuredGridReader(), output / "kymograph.vts")
    n_s, n_t, _ = grid.GetDimensions()
    check(n_s == 201 and n_t >= 129 and (n_t - 1) % FRAMES == 0, f"{name}: dimensions of the kymograph")
    points = vtk_to_numpy(grid.GetPoints().GetData()).reshape(n_t, n_s, 3)
    y, x = np.mgrid[0:1:n_t * 1j, 0:1:n_s * 1j]
    check(close(points[..., 0], x, SINGLE) and close(points[..., 1], y, SINGLE), f"{name}: kymograph over s/L and t/T")
    kymograph = {field: point_data(grid, field).reshape(n_t, n_s)[::(n_t - 1) // FRAMES]
                 for field in ("stretch", "velocity", "active_stress", "friction_force", "displacement")}
    j = np.arange(2 * CELLS * DEGREE)  # the ends of the segments, one after another
    inside = (j // 2 + j % 2) % DEGREE > 0  # those not at the ends of cells, where the stretch may jump
    for i, frame in enumerate(frames):
        at = np.rint(frame["s"] / LENGTH * (n_s - 1)).astype(int)
        for field, values in kymograph.items():
            wanted = frame[field][:, 0] if field == "displacement" else frame[field]
            check(close(values[i, at[inside]], wanted[inside], 3 * SINGLE) and close(values[i, at], wanted, 3e-2),
                  f"{name}: {field} of kymograph and frame {i}")
    return frames, kymograph


def main():
    """Runs on one and two ranks; 1 if any check failed."""
    if len(sys.argv) != 2:
        sys.exit("usage: paraview_files.py PATH_TO_CRAWLER")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        serial = check_run("one rank", run(folder, "one", [sys.argv[1]]))
        script = pathlib.Path(__file__).resolve().parents[2] / "contrib" / "plot" / "kymograph.py"
        subprocess.run([sys.executable, script, folder / "one"], cwd=folder, stdout=subprocess.DEVNULL, check=True)
        check((folder / "one" / "kymograph.png").is_file(), "the picture of a run is beside its files")
        two = check_run("two ranks", run(folder, "two", ["mpirun", "--oversubscribe", "-n", "2", sys.argv[1]]))
    # The same to 1e-9, but where a number may have been rounded to another last digit in the file.
    for i, (a, b) in enumerate(zip(serial[0], two[0])):
        for field in a:
            check(close(a[field], b[field], 1e-9 + SINGLE), f"frame {i}: {field} is the same on one and two ranks")
            same = np.isclose(a[field], b[field], rtol=0, atol=1e-9).mean()
            check(same > 0.95, f"frame {i}: {field} is the same to 1e-9 on one and two ranks")
    for field, values in serial[1].items():
        check(close(values, two[1][field], NINE_DIGITS), f"kymograph: {field} is the same on one and two ranks")
    print(f"{len(serial[0])} frames and a kymograph on one and on two ranks: {len(failures)} checks failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
