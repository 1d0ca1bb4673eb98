#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""FEniCSx: the position form in UFL with elements of high degree; residual and Jacobian by dolfinx, time by PETSc TS.

    F_i = int w^a u_t phi_i + (k (w-1) + m) phi_i,s ds,  w = 1 + u_s,  u = zeta - s,  gamma = L = c = 1

METHOD is "bdfN" or "arkimexN" (TS of petsc4py, adaptive). The Jacobian is derived from the form. Forms are compiled once for
each degree, and kept with their mesh. The lines that are read and written are those of body.h.
"""
import logging
import math
import sys
import time

import dolfinx
import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc


class Body:
    """Forms, vectors and the time stepper of a mesh; the numbers of a body are constants of the forms."""

    def __init__(self, method, degree, cells):
        mesh = dolfinx.mesh.create_unit_interval(MPI.COMM_SELF, cells)
        space = dolfinx.fem.FunctionSpace(mesh, ("Lagrange", degree))
        self.u, self.rate, test = dolfinx.fem.Function(space), dolfinx.fem.Function(space), ufl.TestFunction(space)
        self.constants = {name: dolfinx.fem.Constant(mesh, 0.0) for name in ("a", "chi", "k", "cos", "sin", "sigma")}
        a, chi, k, cosine, sine, sigma = self.constants.values()
        s, two_pi = ufl.SpatialCoordinate(mesh)[0], 2 * math.pi
        # the wave with its time taken out of the sines
        wave = (ufl.cos(two_pi * s) * cosine - ufl.sin(two_pi * s) * sine, ufl.sin(two_pi * s) * cosine + ufl.cos(two_pi * s) * sine)
        m = chi * ((cosine - wave[0]) / two_pi - k * (wave[1] - ufl.sin(two_pi * s)))
        dx = ufl.dx(metadata={"quadrature_degree": 2 * degree + 1})
        w = 1 + self.u.dx(0)
        form = (w**a * self.rate * test + (k * (w - 1) + m) * test.dx(0)) * dx
        options = {"jit_params": {"cffi_extra_compile_args": ["-O3", "-march=native", "-ffast-math"], "cffi_libraries": ["m"]}}
        self.residual = dolfinx.fem.form(form, **options)
        self.jacobian = dolfinx.fem.form(sigma * ufl.derivative(form, self.rate) + ufl.derivative(form, self.u), **options)
        self.mean = dolfinx.fem.form(self.u * ufl.dx, **options)
        self.matrix = dolfinx.fem.petsc.create_matrix(self.jacobian)
        self.force = dolfinx.fem.petsc.create_vector(self.residual)
        self.state = self.force.duplicate()
        self.ts = self.stepper(method)

    def stepper(self, method):
        """TS with sparse LU."""
        ts = PETSc.TS().create(MPI.COMM_SELF)
        ts.setIFunction(self.evaluate, self.force)
        ts.setIJacobian(self.differentiate, self.matrix, self.matrix)
        ts.setEquationType(PETSc.TS.EquationType.IMPLICIT)
        snes = ts.getSNES()
        if method.startswith("bdf"):
            ts.setType("bdf")
            PETSc.Options().setValue("ts_bdf_order", method[3:])
            ts.setFromOptions()
            snes.setType("ksponly")
        else:
            ts.setType("arkimex")
            ts.setARKIMEXType(method.removeprefix("arkimex"))
        snes.getKSP().setType("preonly")
        snes.getKSP().getPC().setType("lu")
        ts.setExactFinalTime(PETSc.TS.ExactFinalTime.MATCHSTEP)
        ts.setMaxSNESFailures(-1)
        ts.setMaxSteps(100000)
        return ts

    def update(self, t, u, rate):
        """State and time into the forms."""
        self.constants["cos"].value = math.cos(2 * math.pi * t)
        self.constants["sin"].value = math.sin(2 * math.pi * t)
        self.u.x.array[:], self.rate.x.array[:] = u.array_r, rate.array_r

    def evaluate(self, _, t, u, rate, force):
        """The residual."""
        self.update(t, u, rate)
        with force.localForm() as local:
            local.set(0)
        dolfinx.fem.petsc.assemble_vector(force, self.residual)

    def differentiate(self, _, t, u, rate, sigma, matrix, __):
        """Its derivative sigma dF/du_t + dF/du."""
        self.update(t, u, rate)
        self.constants["sigma"].value = sigma
        matrix.zeroEntries()
        dolfinx.fem.petsc.assemble_matrix(matrix, self.jacobian)
        matrix.assemble()
        return True

    def run(self, a, chi, k, end_time, tolerance):
        """The displacement."""
        for name, value in (("a", a), ("chi", chi), ("k", k)):
            self.constants[name].value = value
        ts = self.ts
        ts.setTolerances(atol=tolerance, rtol=0)
        ts.getSNES().setTolerances(rtol=1e-3, atol=1e-2 * tolerance)
        ts.setTime(0)
        ts.setStepNumber(0)
        ts.setMaxTime(end_time)
        ts.setTimeStep(max(1e-7, min(1e-3, 1e-2 * math.sqrt(tolerance))))
        ts.restartStep()
        self.state.set(0)
        ts.solve(self.state)
        if ts.getConvergedReason() <= 0:
            return np.nan
        self.u.x.array[:] = self.state.array_r
        return dolfinx.fem.assemble_scalar(self.mean)


def main():
    """Answers line by line."""
    logging.disable()
    bodies = {}
    for line in sys.stdin:
        method, *numbers = line.split()
        a, chi, k, end_time, degree, cells, tolerance, repeat = map(float, numbers)
        key = (method, int(degree), int(cells))
        if key not in bodies:
            bodies[key] = Body(*key)
        start = time.process_time()
        try:
            for _ in range(int(repeat)):
                value = bodies[key].run(a, chi, k, end_time, tolerance)
        except PETSc.Error:
            value = np.nan
        seconds = (time.process_time() - start) / repeat
        print(f"{value:.16g} {seconds:.6g}" if np.isfinite(value) else "failed", flush=True)


if __name__ == "__main__":
    main()
