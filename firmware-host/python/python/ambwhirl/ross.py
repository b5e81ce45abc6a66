"""Rotors of ROSS (https://github.com/petrobras/ross) as scenes.

    from ambwhirl.ross import to_scene
    text = to_scene(rotor)                                        # any ross.Rotor: shaft sections and discs
    to_npz(rotor, "rotor.npz")                                    # cones, layers and internal damping, too
    text = to_scene(rotor, matrices_file="rotor.npz")

What a scene cannot have is named in its first lines, or refused where nothing sensible would be left. ROSS is imported by `to_npz`
alone: it need not be installed for what was loaded otherwise.
"""

from __future__ import annotations

import math
from os import PathLike
from typing import Any, Iterator

import numpy as np

__all__ = ["to_npz", "to_scene"]

DIRECT = ("kxx", "kyy", "cxx", "cyy")
CROSS = ("kxy", "kyx", "cxy", "cyx")
LEFT_OUT = ("mxx", "myy", "mxy", "myx", "kzz", "czz")
REPLACE = "   # assumed: put in your own"


def to_scene(
    rotor: Any,
    title: str = "A rotor of ROSS",
    *,
    spin_hz: float = 50.0,
    bending_to_hz: float | None = None,
    matrices_file: str | None = None,
    sample_rate_hz: float = 20000.0,
    current_max_a: float | None = None,
    clearance_m: float | None = None,
    gravity_m_s2: float = 9.81,
    controller_file: str | None = None,
) -> str:
    """The text of a scene with this rotor; with a file that `to_npz` wrote, by that in the place of shaft and discs.

    Bearings and seals become supports. Magnetic bearings become planes with magnet, sensor and controller, in newtons: ki times
    the current, which is at most `current_max_a`, else the bias; the controllers are ROSS's or, with `controller_file`, a state
    space that is yet to be designed. Their magnets fail for 30 ms: the rotor drops. Without magnets there is a plane at each
    bearing, at most four. The clearance is half the air gap unless it is given.

    Bending modes are kept up to ten times the spin and 2 kHz at least, unless `bending_to_hz` says otherwise.
    """
    magnets = [b for b in rotor.bearing_elements if _is_magnetic(b)]
    others = [b for b in rotor.bearing_elements if not _is_magnetic(b)]
    ends = magnets or [b for b in others if type(b).__name__.endswith("BearingElement")][:4]
    if len(magnets) > 4:
        raise ValueError(f"{len(magnets)} magnetic bearings: a scene has four planes at most")
    to_hz = max(2000.0, 10.0 * abs(spin_hz)) if bending_to_hz is None else bending_to_hz
    gap_m = min((float(b.g0) for b in magnets), default=4e-4)
    places = rotor.nodes_pos
    out = [f"# Not as in ROSS: {loss}." for loss in _lost(rotor, matrices_file is not None)]
    out += [
        f'title = "{title}"',
        "[run]",
        f"duration_s = {0.3 if magnets else 0.1}",
        f"sample_rate_hz = {_number(sample_rate_hz)}",
        'policies = ["levitation", "supervisor"]' if magnets else 'policies = ["passive"]',
        "[rotor]",
        f"bending_to_hz = {_number(to_hz)}",
        f'matrices_file = "{matrices_file}"' if matrices_file else "elements = 24",
        *([f"gravity_m_s2 = [0.0, {_number(-gravity_m_s2)}]"] if magnets and gravity_m_s2 else []),
        "[spin]",
        f"frequency_hz = {_number(spin_hz)}",
        "[contact]",
        f"clearance_m = {_number(clearance_m or 0.5 * gap_m)}{'' if clearance_m else REPLACE}",
        f"stiffness_n_m = 1e8{REPLACE}",
        *([f"restitution = 0.7{REPLACE}"] if magnets else []),
        "[friction]",
        f"coefficient = 0.15{REPLACE}",
        *([] if magnets else ["[verdict]", "whirl_speed_m_s = 1.0"]),
    ]
    if controller_file:
        out += ["[state_space]", f'file = "{controller_file}"', "feed_forward_weight = true"]
    if magnets:
        out += ["[[outage]]   # the rotor drops", "start_s = 0.05", "duration_s = 0.03"]
    for layer in [] if matrices_file else _layers(rotor):
        out.append("[[shaft]]")
        out += [f"{key} = {_number(value)}" for key, value in layer.items()]
    for disc in [] if matrices_file else rotor.disk_elements:
        out += [
            "[[disc]]",
            f"position_m = {_number(places[disc.n])}",
            f"mass_kg = {_number(disc.m)}",
            f"transverse_inertia_kg_m2 = {_number(disc.Id)}",
            f"polar_inertia_kg_m2 = {_number(disc.Ip)}",
        ]
    for bearing in others:
        direct, cross = _coefficients(bearing, DIRECT), _coefficients(bearing, CROSS)
        out += [
            "[[support]]",
            f"position_m = {_number(places[bearing.n])}",
            f"stiffness_n_m = {direct[:2]!r}",
            f"damping_n_s_m = {direct[2:]!r}",
            f"cross_stiffness_n_m = {cross[:2]!r}",
            f"cross_damping_n_s_m = {cross[2:]!r}",
        ]
    for i, bearing in enumerate(ends):
        radius_m = 0.5 * max(float(e.odl) for e in rotor.shaft_elements if e.n in (bearing.n, bearing.n - 1))
        out += [
            "[[plane]]",
            f'name = "bearing {i + 1}"',
            f"position_m = {_number(places[bearing.n])}",
            f"contact_radius_m = {_number(radius_m)}",
        ]
        if magnets:
            out += _magnet(bearing, current_max_a)
            out += [] if controller_file else _controller(bearing, sample_rate_hz)
    return "\n".join(out) + "\n"


def _number(x: float) -> str:
    """As TOML has it, without the digits in which sums of lengths differ from what was meant."""
    return repr(float(f"{float(x):.12g}"))


def _is_magnetic(bearing: Any) -> bool:
    return hasattr(bearing, "ki") and hasattr(bearing, "ks")


def _alike(bearing: Any, name: str) -> float:
    """A value that ROSS may have for each axis, and a scene for both."""
    values = np.ravel(getattr(bearing, name)).astype(float)
    if values.min() != values.max():
        raise ValueError(f"bearing at node {bearing.n}: {name} differs between the axes; a scene has one for both")
    return float(values[0])


def _magnet(bearing: Any, current_max_a: float | None) -> list[str]:
    """Magnet and sensor of a plane."""
    ki, ks, bias_a = (_alike(bearing, name) for name in ("ki", "ks", "i0"))
    most_a = bias_a if current_max_a is None else current_max_a
    axes_deg = math.degrees(float(bearing.sensors_axis_rotation))
    return [
        "[plane.magnet]",
        f"force_max_n = {_number(ki * most_a)}   # ki = {ki:.6g} N/A times {most_a:g} A{'' if current_max_a else ', the bias'}",
        f"negative_stiffness_n_m = {_number(-ks)}   # -ks",
        "# lag_s = 1e-4: the amplifier of ROSS has none",
        f"# in its place the pull of the poles, with a lag: poles = {{ bias_current_a = {_number(bias_a)}, air_gap_m = {_number(bearing.g0)} }}",
        f"axes_deg = {_number(axes_deg)}",
        "[plane.sensor]",
        f"axes_deg = {_number(axes_deg)}",
    ]


def _controller(bearing: Any, sample_rate_hz: float) -> list[str]:
    """Its gains, or its transfer function as second-order sections."""
    newtons = _alike(bearing, "ki") * _alike(bearing, "k_amp") * _alike(bearing, "k_sense")
    if bearing.controller_transfer_function_num is None:
        return [
            "[plane.levitation]",
            f"proportional_n_m = {_number(newtons * bearing.kp_pid)}   # ki times the gains of ROSS, in A/m",
            f"integral_n_m_s = {_number(newtons * bearing.ki_pid)}",
            f"derivative_n_s_m = {_number(newtons * bearing.kd_pid)}",
            f"derivative_filter_s = {_number(1.0 / bearing.n_f)}",
            "feed_forward_weight = true",
        ]
    # ROSS brings SciPy.
    from scipy import signal

    given = [np.ravel(getattr(bearing, f"controller_transfer_function_{part}")).astype(float) for part in ("num", "den")]
    zeros, poles, gain = signal.tf2zpk(*given)
    if len(zeros) > len(poles):
        raise ValueError(f"bearing at node {bearing.n}: its controller has more zeros than poles; give it a filter")
    sections = signal.zpk2sos(*signal.bilinear_zpk(zeros, poles, gain, sample_rate_hz))
    return [
        "[plane.biquads]",
        f"gain_n_m = {_number(newtons)}",
        f"sections = {np.ravel(sections).tolist()!r}",
        "feed_forward_weight = true",
    ]


def _coefficients(bearing: Any, names: tuple[str, ...]) -> list[float]:
    """Those of the lowest speed."""
    return [float(getattr(bearing, name)[0]) for name in names]


def _lost(rotor: Any, by_matrices: bool) -> Iterator[str]:
    """What a scene of the rotor leaves out, in words; what it cannot be without is an error."""
    if len(getattr(rotor, "point_mass_elements", [])) > 0:
        raise ValueError("point masses: a scene has discs on the shaft alone")
    shaft = [] if by_matrices else rotor.shaft_elements
    for what, has in [
        ("cones by their mean diameters", lambda e: e.odl != e.odr or e.idl != e.idr),
        ("without internal damping (alpha, beta)", lambda e: e.alpha or e.beta),
        ("without axial force and torque", lambda e: e.axial_force or e.torque),
        ("with shear, inertia and gyroscopic effect of sections that ROSS has without", _lacks_effects),
    ]:
        nodes = [str(e.n) for e in shaft if has(e)]
        if nodes:
            yield f"{what}, at node {nodes[0]}{f' and {len(nodes) - 1} more' if len(nodes) > 1 else ''}; matrices_file keeps that"
    for bearing in rotor.bearing_elements:
        name = f"bearing at node {bearing.n}"
        if bearing.n_link is not None:
            raise ValueError(f"{name}: is linked to node {bearing.n_link}; a scene has supports to ground")
        if _is_magnetic(bearing):
            yield f"{name}: its controller is sampled and a sample late; forces have a cap; the weight is fed forward"
            continue
        varies = [c for c in DIRECT + CROSS if max(getattr(bearing, c)) != min(getattr(bearing, c))]
        if varies:
            yield f"{name}: {', '.join(varies)} at the lowest speed alone"
        left_out = [c for c in LEFT_OUT if np.any(getattr(bearing, c, 0))]
        if left_out:
            yield f"{name}: without {', '.join(left_out)}"


def _lacks_effects(element: Any) -> bool:
    return not (element.shear_effects and element.rotary_inertia and element.gyroscopic)


def _layers(rotor: Any) -> Iterator[dict[str, float]]:
    """Shaft elements from left to right; several at one place are refused."""
    last = -1
    for element in sorted(rotor.shaft_elements, key=lambda e: e.n):
        if element.n == last:
            raise ValueError(f"two shaft elements at node {element.n}: a scene has one; matrices_file keeps both")
        last = element.n
        yield {
            "length_m": element.L,
            "outer_diameter_m": 0.5 * (element.odl + element.odr),
            "inner_diameter_m": 0.5 * (element.idl + element.idr),
            "density_kg_m3": element.material.rho,
            "youngs_modulus_n_m2": element.material.E,
            "poisson_ratio": element.material.Poisson,
        }


def to_npz(rotor: Any, path: str | PathLike[str]) -> None:
    """Writes the free rotor as matrices of one plane: M, K, D, G, places_m and displacement.

    Shaft elements and discs are taken as ROSS has them, bearings are not in it. A rotor that is not the same in both planes, or
    whose planes are coupled by more than its spin, is refused.
    """
    import ross

    free = ross.Rotor(rotor.shaft_elements, rotor.disk_elements)
    per = free.number_dof
    # A node's motions: x, y, z, rotations about x, y, z; dx/dz is the one about y, dy/dz minus that about x.
    slope_y, slope_x = (2, 3) if per == 4 else (3, 4)
    nodes = np.arange(free.ndof // per)
    along_x = np.ravel([[per * i, per * i + slope_x] for i in nodes])
    along_y = np.ravel([[per * i + 1, per * i + slope_y] for i in nodes])
    sign = np.tile([1.0, -1.0], len(nodes))
    out = {}
    for name, given in [("M", free.M()), ("K", free.K(0.0)), ("D", free.C(0.0))]:
        matrix = np.asarray(given)
        in_x = matrix[np.ix_(along_x, along_x)]
        in_y = matrix[np.ix_(along_y, along_y)] * np.outer(sign, sign)
        across = matrix[np.ix_(along_x, along_y)]
        if max(np.abs(in_x - in_y).max(), np.abs(across).max()) > 1e-9 * np.abs(in_x).max():
            raise ValueError(f"{name} differs between the planes, or couples them")
        out[name] = 0.5 * (in_x + in_x.T)
    if not out["D"].any():
        del out["D"]
    gyroscopic = np.asarray(free.G())[np.ix_(along_x, along_y)] * sign
    out["G"] = 0.5 * (gyroscopic + gyroscopic.T)
    out["places_m"] = np.asarray(free.nodes_pos, dtype=float)
    displacement = np.zeros((len(nodes), len(sign)))
    displacement[nodes, 2 * nodes] = 1.0
    out["displacement"] = displacement
    np.savez_compressed(path, **out)
