#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the files of a run the way ParaView does, with VTK's own readers and filters, and checks what they hold.

    python3 paraview_files.py PATH_TO_CRAWLER MPIEXEC          needs python3-vtk9

The same scene is run on one rank and on two, and as XDMF; all must give the same fields. An adaptive mesh, a level
without a mesh and a run that is killed must leave whole animations, too.
"""
import pathlib
import signal
import sys
from xml.etree import ElementTree

try:
    import h5py
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as error:
    sys.exit(f"{error}; the Debian packages python3-vtk9 and python3-h5py are expected (and /usr/bin/python3)")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, on_ranks, prm  # noqa: E402
from tables import json_of  # noqa: E402

# The points of the VTU files are then every fourth of the 201 points of the kymograph, and frames are every 16th row.
LENGTH, END_TIME, FRAMES, CELLS, DEGREE = 2.0, 1.5, 8, 10, 5
SCENE = prm(f"Body/Length={LENGTH}", "Active stress/Optimal wave/Choose wave by=wave speed",
            f"Discretization/Degree={DEGREE}", f"Discretization/Number of cells={CELLS}",
            "Discretization/Share cells=yes", f"Time/End time={END_TIME}", "Time/Tolerance=1e-8",
            f"Output/Number of snapshots={FRAMES}")
FIELDS = {"displacement": 1, "position": 1, "stretch": 1, "velocity": 1, "active_stress": 1, "elastic_stress": 1,
          "friction_force": 1}
XDMF = ("Output/Snapshot format=xdmf",)
ADAPTIVE = ("Discretization/Degree=2", "Discretization/Number of cells=automatic", "Discretization/Mesh=adaptive")
NO_MESH = ("Model=perturbation", "Accuracy=0.1", "Active stress/Optimal wave/Perturbation parameter=0.01")
PARTS = ("body", "grip", "ground", "scale")
REST_THICKNESS = LENGTH / 10
ROUND_OFF = 1e-13  # of sums of two numbers of size 1
NINE_DIGITS = 1e-8



def close(found, wanted, tolerance):
    """Whether all values agree within the tolerance times the largest, at least 1."""
    found, wanted = np.asarray(found, dtype=float), np.asarray(wanted, dtype=float)
    return found.shape == wanted.shape and np.abs(found - wanted).max() <= tolerance * max(1.0, np.abs(wanted).max())


def run(folder, name, command, entries=()):
    """Runs the scene, with other values of these entries, into a folder of this name."""
    file, output = folder / "scene.prm", folder / name
    file.write_text(SCENE)
    command = [*command, "run", str(file), "--quiet", "--output", str(output)]
    for entry in entries:
        command += ["--set", entry]
    done = call(command)
    if done.returncode != 0:
        sys.exit(f"{name}: exits with {done.returncode}: {done.stderr[-2000:]}")
    return output


def read(reader, path):
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


def cells_of(data):
    """The points of all cells, which must be of one type."""
    return np.array([[data.GetCell(i).GetPointId(j) for j in range(data.GetCell(i).GetNumberOfPoints())]
                     for i in range(data.GetNumberOfCells())])


def check_arrays(name, data, fields, active):
    """Names, components, precision, units and the active scalars of point data; returns the fields."""
    found = {field: point_data(data, field) for field in fields}
    for field, components in fields.items():
        array = data.GetPointData().GetArray(field)
        expect(array.GetNumberOfComponents() == components, f"{name}: {field} has {components} component(s)")
        expect(array.GetDataType() == vtk.VTK_DOUBLE, f"{name}: {field} is in double precision")
        expect(array.GetInformation().Has(vtk.vtkDataArray.UNITS_LABEL()), f"{name}: {field} has a unit")
        expect(np.isfinite(found[field]).all(), f"{name}: {field} is finite")
    expect(data.GetPointData().GetNumberOfArrays() == len(fields), f"{name}: no other fields")
    expect(data.GetPoints().GetDataType() == vtk.VTK_DOUBLE, f"{name}: points are in double precision")
    scalars = data.GetPointData().GetScalars()
    expect((scalars.GetName() if scalars else None) == active, f"{name}: active scalars are {active}")
    return found


def check_line(name, data, moment):
    """Everything that the line of a frame must hold; returns its fields, ordered along the body."""
    fields = check_arrays(name, data, {**FIELDS, "displacement": 3}, "stretch")
    points = vtk_to_numpy(data.GetPoints().GetData())
    s = points[:, 0]
    expect(data.GetNumberOfCells() == CELLS * DEGREE, f"{name}: number of line segments")
    expect(s.min() == 0 and abs(s.max() - LENGTH) < ROUND_OFF and not points[:, 1:].any(), f"{name}: points from 0 to L")
    stored = data.GetFieldData().GetArray("TimeValue")
    expect(stored is not None and abs(stored.GetValue(0) - moment) <= ROUND_OFF, f"{name}: TimeValue is {moment}")

    position, stretch = fields["position"], fields["stretch"]
    expect(not fields["displacement"][:, 1:].any(), f"{name}: displacement is along x")
    expect(close(position, s + fields["displacement"][:, 0], ROUND_OFF), f"{name}: position = s + displacement")
    expect(close(fields["elastic_stress"], stretch - 1, ROUND_OFF), f"{name}: elastic stress k (stretch - 1), k = 1")
    expect(close(fields["friction_force"] * stretch, fields["velocity"], ROUND_OFF),
           f"{name}: friction is velocity/stretch, a = -1")
    ends = cells_of(data)
    slope = np.diff(position[ends], axis=1)[:, 0] / np.diff(s[ends], axis=1)[:, 0]
    expect(np.allclose(slope, stretch[ends].mean(axis=1), rtol=0.03), f"{name}: stretch is the slope of the position")

    warp = vtk.vtkWarpVector()
    warp.SetInputData(data)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.Update()
    warped = vtk_to_numpy(warp.GetOutput().GetPoints().GetData())
    expect(close(warped[:, 0], position, ROUND_OFF) and not warped[:, 1:].any(),
           f"{name}: Warp By Vector gives the position")
    return {"s": s, **fields, "displacement": fields["displacement"][:, 0]}


def check_body(name, data, line):
    """The ribbon: quadrilaterals at the present place, of the thickness L/10 over the stretch, and the line's fields."""
    fields = check_arrays(name, data, {**FIELDS, "s": 1, "ground_force": 3}, "stretch")
    points = vtk_to_numpy(data.GetPoints().GetData())
    bottom, top = points[::2], points[1::2]
    for field, values in line.items():
        expect((fields[field][::2] == values).all() and (fields[field][1::2] == values).all(),
               f"{name}: {field} is that of the line, on both edges")
    expect((bottom[:, 0] == line["position"]).all() and (top[:, 0] == line["position"]).all(),
           f"{name}: points are at their place on the ground")
    expect(not bottom[:, 1].any() and close(top[:, 1], REST_THICKNESS / line["stretch"], ROUND_OFF),
           f"{name}: the thickness is L/10 over the stretch")
    cells = cells_of(data)
    expect(cells.shape == (CELLS * DEGREE, 4), f"{name}: quadrilaterals")
    x, y = points[cells, 0], points[cells, 1]
    areas = 0.5 * ((x * np.roll(y, -1, axis=1)).sum(axis=1) - (np.roll(x, -1, axis=1) * y).sum(axis=1))
    expect((areas > 0).all(), f"{name}: no quadrilateral is turned over")
    expect(abs(areas.sum() / (LENGTH * REST_THICKNESS) - 1) < 0.01, f"{name}: the area is kept, {areas.sum()}")
    expect(close(fields["ground_force"][:, 0], -fields["friction_force"], 0), f"{name}: the ground's force on the body")


def check_scenery(name, parts, lines):
    """Ground under the whole path, arrows along the forces, and the range of all fields from the first frame on, of
    those that jumps make large without what is larger for 2 % of body and time."""
    left, right = (f(line["position"]) for f, line in ((min, lines[0]), (max, lines[-1])))
    for line in lines:
        left, right = min(left, line["position"].min()), max(right, line["position"].max())
    bounds = parts[0]["ground"].GetBounds()
    expect(abs(bounds[0] - left + 0.15 * LENGTH) < ROUND_OFF and abs(bounds[1] - right - 0.15 * LENGTH) < ROUND_OFF,
           f"{name}: the ground is below the whole path")
    expect(bounds[2] < 0 and bounds[3] == 0, f"{name}: the ground ends at y = 0")
    for field in FIELDS:
        values = np.concatenate([line[field] for line in lines])
        expected = np.array([values.min(), values.max()])
        if field in ("velocity", "friction_force"):
            size = usual_size([at_grips(line, field) for line in lines])
            expected = np.clip(expected, -size, size)
        expect(close(parts[0]["scale"].GetPointData().GetArray(field).GetRange(), expected, 1e-12),
               f"{name}: the scale of {field} is that of the run")
    for i, part in enumerate(parts):
        usual = usual_size([at_grips(line, "friction_force") for line in lines[:i + 1]])
        corners = vtk_to_numpy(part["grip"].GetPoints().GetData()).reshape(-1, 3, 3)
        force = vtk_to_numpy(part["grip"].GetPointData().GetArray("friction_force"))[::3]
        expect(len(corners) == 24, f"{name}: 24 arrows")
        expect(close(corners[:, 1, 0] - corners[:, 0, 0], -0.15 * LENGTH * np.clip(force / usual, -1, 1), 1e-12),
               f"{name}, frame {i}: arrows are the forces of the ground on the body")


def at_grips(line, field):
    """A field where the arrows are."""
    return np.interp((np.arange(24) + 0.5) / 24 * LENGTH, line["s"], line[field])


def usual_size(rows):
    """What 98 % of the sizes do not exceed, up to an eighth of a factor of two; the first row lasts no time."""
    sizes = np.sort(np.abs(np.concatenate(rows[1:] or rows)))
    largest = np.abs(rows).max()
    if len(rows) == 1:
        return largest
    below = sizes[max(0, int(np.ceil(0.98 * len(sizes) - 1e-9)) - 1)]
    return min(largest, 2 ** ((np.floor(8 * np.log2(below)) + 1) / 8))


def listed(output, name):
    """The times of a .pvd file, and for each of them the files of its parts."""
    frames = {}
    for entry in ElementTree.parse(output / name).getroot().findall("Collection/DataSet"):
        frames.setdefault(float(entry.get("timestep")), {})[entry.get("name")] = output / entry.get("file")
    return list(frames), list(frames.values())


def check_run(name, output):
    """All files of a run; returns the fields of every frame and of the kymograph."""
    times, files = listed(output, "solution.pvd")
    line_times, lines = listed(output, "line.pvd")
    expect(close(times, [END_TIME * i / FRAMES for i in range(FRAMES + 1)], 1e-12), f"{name}: times of the frames")
    expect(times == line_times, f"{name}: body and line have the same times")
    expect(all(tuple(parts) == PARTS for parts in files), f"{name}: the parts of each frame")
    expect({file for frame in files + lines for file in frame.values()} == set((output / "solution").iterdir()),
           f"{name}: the files that exist are listed")
    parts = [{part: read(vtk.vtkXMLUnstructuredGridReader(), file) for part, file in frame.items()} for frame in files]
    frames = [check_line(f"{name}, line {i}", read(vtk.vtkXMLUnstructuredGridReader(), lines[i]["line"]), moment)
              for i, moment in enumerate(times)]
    for i, frame in enumerate(frames):
        check_body(f"{name}, frame {i}", parts[i]["body"], frame)
    check_scenery(name, parts, frames)

    expect(not frames[0]["displacement"].any(), f"{name}: starts at rest")
    last, summary = frames[-1], json_of(output / "summary.json")
    moved = np.trapz(last["displacement"], last["s"]) / LENGTH
    expect(abs(moved / summary["displacement"] - 1) < 1e-3,
           f"{name}: the last frame has moved as far as summary.json says")

    grid = read(vtk.vtkXMLStructuredGridReader(), output / "kymograph.vts")
    n_s, n_t, _ = grid.GetDimensions()
    expect(n_s == 201 and n_t >= 129 and (n_t - 1) % FRAMES == 0, f"{name}: dimensions of the kymograph")
    titles = [grid.GetFieldData().GetAbstractArray(f"AxisTitleFor{axis}").GetValue(0) for axis in "XY"]
    scales = [grid.GetFieldData().GetArray(name).GetValue(0) for name in "LT"]
    expect(titles == ["s/L", "t/T"] and scales == [LENGTH, END_TIME], f"{name}: axes of the kymograph")
    expect(grid.GetPointData().GetScalars().GetName() == "stretch", f"{name}: active scalars of the kymograph")
    points = vtk_to_numpy(grid.GetPoints().GetData()).reshape(n_t, n_s, 3)
    y, x = np.mgrid[0:1:n_t * 1j, 0:1:n_s * 1j]
    expect(close(points[..., 0], x, ROUND_OFF) and close(points[..., 1], y, ROUND_OFF), f"{name}: kymograph over s/L and t/T")
    kymograph = {field: point_data(grid, field).reshape(n_t, n_s)[::(n_t - 1) // FRAMES]
                 for field in ("stretch", "velocity", "active_stress", "friction_force", "displacement")}
    inside = np.arange(CELLS * (DEGREE + 1)) % (DEGREE + 1) % DEGREE > 0  # at the ends of cells the stretch may jump
    for i, frame in enumerate(frames):
        at = np.rint(frame["s"] / LENGTH * (n_s - 1)).astype(int)
        for field, values in kymograph.items():
            wanted = frame[field]
            expect(close(values[i, at[inside]], wanted[inside], 1e-12) and close(values[i, at], wanted, 3e-2),
                   f"{name}: {field} of kymograph and frame {i}")
    return frames, kymograph


def check_xdmf(name, output, frames):
    """The HDF5 file has the numbers of these frames, and the description names their places in it."""
    with h5py.File(output / "solution.h5") as file:
        n_frames, most = file["line/s"].shape
        expect(n_frames == len(frames) == len(file["time"]), f"{name}: all frames and no others")
        expect(file["body/stretch"].shape == (n_frames, most, 2), f"{name}: both edges of the body")
        for i, frame in enumerate(frames):
            n = file["n_points"][i]
            expect(n == len(frame["s"]) and np.isnan(file["line/s"][i, n:]).all(), f"{name}, frame {i}: points")
            for field, values in frame.items():
                expect((file[f"line/{field}"][i, :n] == values).all(), f"{name}, frame {i}: {field} is that of the .vtu")
                expect((file[f"body/{field}"][i, :n] == values[:, np.newaxis]).all(), f"{name}, frame {i}: {field}, body")
        expect(file["body/velocity"].attrs["unit"] == b"length/time", f"{name}: units in the HDF5 file")
        stored = {part: file[part][:] for part in ("body/points", "body/stretch", "line/points", "grip/points")}
        times, n_points = file["time"][:], file["n_points"][:]
    raw = (output / "solution.h5").read_bytes()
    for description in ("solution.xdmf", "line.xdmf"):
        grids = ElementTree.parse(output / description).getroot().findall("Domain/Grid/Grid")
        expect([float(grid.find("Time").get("Value")) for grid in grids] == list(times), f"{name}: times in {description}")
        for i, grid in enumerate(grids):
            for part in grid.findall("Grid") or [grid]:
                items = [("points", part.find("Geometry/DataItem"))]
                items += [(field.get("Name"), field.find("DataItem")) for field in part.findall("Attribute")]
                for field, item in items:
                    dataset = f"{part.get('Name')}/{field}"
                    if dataset in stored:
                        shape = [int(word) for word in item.get("Dimensions").split()]
                        found = np.frombuffer(raw, "<f8", int(np.prod(shape)), int(item.get("Seek"))).reshape(shape)
                        n = shape[0] if dataset.startswith("grip") else n_points[i]
                        expect((found == stored[dataset][i, :n]).all(), f"{name}: {dataset} of frame {i} in {description}")


def check_killed(folder, program):
    """After a kill the HDF5 file has all frames that solution.xdmf names."""
    file, output = folder / "endless.prm", folder / "killed"
    file.write_text("subsection Discretization\n set Number of cells = 50\nend\n"
                    "subsection Time\n set Step control = fixed\n set Initial step = 1e-6\nend\n"
                    "subsection Output\n set Number of snapshots = 2000\n set Snapshot format = xdmf\nend\n")
    done = call([program, "run", file, "--quiet", "--output", output], stop_at="step:15000:KILL")
    expect(done.returncode == -signal.SIGKILL, f"the run to be killed: {done.returncode}, {done.stderr}")
    grids = ElementTree.parse(output / "solution.xdmf").getroot().findall("Domain/Grid/Grid")
    with h5py.File(output / "solution.h5") as data:
        expect(len(grids) > 20, "frames of the run that was killed")
        expect(not np.isnan(data["time"][:len(grids)]).any(), "killed: all frames that solution.xdmf names are there")
        expect(np.isfinite(data["line/stretch"][:len(grids)]).all() and np.isnan(data["time"][-1]), "killed: whole frames")


def vtu_frames(output):
    frames = []
    for parts in listed(output, "line.pvd")[1]:
        data = read(vtk.vtkXMLUnstructuredGridReader(), parts["line"])
        fields = {field: point_data(data, field) for field in FIELDS}
        frames.append({"s": vtk_to_numpy(data.GetPoints().GetData())[:, 0], **fields,
                       "displacement": fields["displacement"][:, 0]})
    return frames


def main(folder):
    serial = check_run("one rank", run(folder, "one", [sys.argv[1]]))
    script = pathlib.Path(__file__).resolve().parents[2] / "contrib/python/crawler/plot" / "kymograph.py"
    done = call([sys.executable, script, folder / "one"], folder)
    expect(done.returncode == 0 and (folder / "one" / "kymograph.png").is_file(), "the picture of a run is beside its files")
    check_xdmf("XDMF", run(folder, "xdmf", [sys.argv[1]], XDMF), serial[0])
    expect(sorted(path.name for path in (folder / "xdmf").glob("*solution*")) == ["solution.h5", "solution.xdmf"],
           "XDMF: one pair of files")
    for name, more in (("adaptive", ADAPTIVE), ("no mesh", NO_MESH)):
        frames = vtu_frames(run(folder, name, [sys.argv[1]], more))
        if name == "adaptive":
            expect(len({len(frame["s"]) for frame in frames}) > 1, "the mesh changes between frames")
        check_xdmf(name, run(folder, name + " XDMF", [sys.argv[1]], more + XDMF), frames)
    check_killed(folder, sys.argv[1])
    two = check_run("two ranks", run(folder, "two", [*on_ranks(sys.argv[2], 2), sys.argv[1]]))
    for i, (a, b) in enumerate(zip(serial[0], two[0])):
        for field in a:
            expect(close(a[field], b[field], 1e-9), f"frame {i}: {field} is the same on one and two ranks")
    for field, values in serial[1].items():
        expect(close(values, two[1][field], NINE_DIGITS), f"kymograph: {field} is the same on one and two ranks")
    print(f"{len(serial[0])} frames and a kymograph on one and on two ranks")


checks.run((main,))
