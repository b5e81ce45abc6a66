"""Saves the free rotor of a ROSS model as matrices of one plane, for `rotor.matrices_file` of a scene.

    from to_npz import to_npz
    to_npz(rotor, "rotor.npz")          # any ross.Rotor

Shaft elements and discs are taken as ROSS has them: conical ones, several at one node, internal damping. Bearings are not in it;
`to_scene` writes them as supports. A rotor that is not the same in both planes is refused.
"""

import numpy as np
import ross as rs


def to_npz(rotor, path):
    """Writes M, K, D, G, places_m and displacement."""
    free = rs.Rotor(rotor.shaft_elements, rotor.disk_elements)
    per = free.number_dof
    # A node's motions: x, y, z, rotations about x, y, z; dx/dz is the one about y, dy/dz minus that about x.
    slope_y, slope_x = (2, 3) if per == 4 else (3, 4)
    nodes = np.arange(free.ndof // per)
    along_x = np.ravel([[per * i, per * i + slope_x] for i in nodes])
    along_y = np.ravel([[per * i + 1, per * i + slope_y] for i in nodes])
    sign = np.tile([1.0, -1.0], len(nodes))

    def plane(matrix, rows, columns, of_rows, of_columns):
        return matrix[np.ix_(rows, columns)] * np.outer(of_rows, of_columns)

    one = np.ones(len(sign))
    out = {}
    for name, matrix in [("M", free.M()), ("K", free.K(0.0)), ("D", free.C(0.0))]:
        matrix = np.asarray(matrix)
        in_x = plane(matrix, along_x, along_x, one, one)
        in_y = plane(matrix, along_y, along_y, sign, sign)
        if np.abs(in_x - in_y).max() > 1e-9 * np.abs(in_x).max():
            raise ValueError(f"{name} differs between the planes")
        out[name] = 0.5 * (in_x + in_x.T)
    if not out["D"].any():
        del out["D"]
    gyroscopic = plane(np.asarray(free.G()), along_x, along_y, one, sign)
    out["G"] = 0.5 * (gyroscopic + gyroscopic.T)
    out["places_m"] = np.asarray(free.nodes_pos, dtype=float)
    displacement = np.zeros((len(nodes), len(sign)))
    displacement[nodes, 2 * nodes] = 1.0
    out["displacement"] = displacement
    np.savez_compressed(path, **out)
