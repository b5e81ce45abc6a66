"""Writes a rotor of ROSS (https://github.com/petrobras/ross) as a scene: shaft, discs, and bearings as supports.

    python to_scene.py scene.toml            # ROSS's own example
    from to_scene import to_scene            # of any ross.Rotor

Taken over: shaft elements (cylindrical; of a cone the mean diameters), their material, discs, and of bearings and seals
stiffness and damping, direct and cross-coupled. What is lost is named at the top of the scene: coefficients that change with
speed are those of the lowest, masses of bearings are left out. An element that a scene cannot have is refused: a link to
another node, and a magnetic bearing, whose coefficients are those of its controller at a frequency; give that as [magnet] and
[levitation]. Bearing planes with a retainer bearing are the user's to add; one is written at each bearing with numbers to be
replaced.
"""

import sys
from pathlib import Path


def to_scene(rotor, title="A rotor of ROSS", bending_to_hz=2e4, spin_hz=50.0, matrices_file=None):
    """TOML text of a scene with this rotor; with a file that `to_npz` wrote, by that in the place of shaft and discs."""
    out = [f"# Not as in ROSS: {loss}." for loss in lost(rotor)]
    out += [
        f'title = "{title}"',
        "[run]",
        "duration_s = 0.1",
        "sample_rate_hz = 20000",
        'policies = ["passive"]',
        "[rotor]",
        f"bending_to_hz = {bending_to_hz!r}",
        f'matrices_file = "{matrices_file}"' if matrices_file else "elements = 24",
        "[spin]",
        f"frequency_hz = {spin_hz!r}",
        "[contact]",
        "clearance_m = 2e-4",
        "stiffness_n_m = 1e8",
        "[friction]",
        "coefficient = 0.15",
        "[verdict]",
        "whirl_speed_m_s = 1.0",
    ]
    places = [float(z) for z in rotor.nodes_pos]
    for layer in [] if matrices_file else layers(rotor):
        out.append("[[shaft]]")
        out += [f"{key} = {value!r}" for key, value in layer.items()]
    for disc in [] if matrices_file else rotor.disk_elements:
        out += [
            "[[disc]]",
            f"position_m = {places[disc.n]!r}",
            f"mass_kg = {float(disc.m)!r}",
            f"transverse_inertia_kg_m2 = {float(disc.Id)!r}",
            f"polar_inertia_kg_m2 = {float(disc.Ip)!r}",
        ]
    for bearing in rotor.bearing_elements:
        direct, cross = coefficients(bearing, DIRECT), coefficients(bearing, CROSS)
        out += [
            "[[support]]",
            f"position_m = {places[bearing.n]!r}",
            f"stiffness_n_m = {direct[:2]!r}",
            f"damping_n_s_m = {direct[2:]!r}",
            f"cross_stiffness_n_m = {cross[:2]!r}",
            f"cross_damping_n_s_m = {cross[2:]!r}",
        ]
    ends = [b for b in rotor.bearing_elements if type(b).__name__.endswith("BearingElement")][:4]
    for i, bearing in enumerate(ends):
        out += [
            "[[plane]]",
            f'name = "bearing {i + 1}"',
            f"position_m = {places[bearing.n]!r}",
            "contact_radius_m = 0.05",
        ]
    return "\n".join(out) + "\n"


DIRECT = ("kxx", "kyy", "cxx", "cyy")
CROSS = ("kxy", "kyx", "cxy", "cyx")


def coefficients(bearing, names):
    """Those of the lowest speed."""
    return [float(getattr(bearing, name)[0]) for name in names]


def lost(rotor):
    """What a scene of the rotor leaves out, in words; what it cannot be without is an error."""
    for bearing in rotor.bearing_elements:
        name = f"bearing at node {bearing.n}"
        if bearing.n_link is not None:
            raise ValueError(f"{name}: is linked to node {bearing.n_link}; a scene has supports to ground")
        if type(bearing).__name__.startswith("Magnetic"):
            raise ValueError(f"{name}: is magnetic; give it as [magnet] and [levitation]")
        varies = [c for c in DIRECT + CROSS if max(getattr(bearing, c)) != min(getattr(bearing, c))]
        if varies:
            yield f"{name}: {', '.join(varies)} at the lowest speed alone"
        masses = [c for c in ("mxx", "myy", "mxy", "myx") if any(x != 0 for x in getattr(bearing, c, []))]
        if masses:
            yield f"{name}: without {', '.join(masses)}"


def layers(rotor):
    """Shaft elements from left to right; several at one place are refused."""
    last = -1
    for element in sorted(rotor.shaft_elements, key=lambda e: e.n):
        if element.n == last:
            raise ValueError(f"two shaft elements at node {element.n}: a scene has one")
        last = element.n
        yield {
            "length_m": float(element.L),
            "outer_diameter_m": 0.5 * float(element.odl + element.odr),
            "inner_diameter_m": 0.5 * float(element.idl + element.idr),
            "density_kg_m3": float(element.material.rho),
            "youngs_modulus_n_m2": float(element.material.E),
            "poisson_ratio": float(element.material.Poisson),
        }


if __name__ == "__main__":
    import ross

    # Not to standard output: importing ROSS prints there.
    Path(sys.argv[1]).write_text(to_scene(ross.rotor_example(), "ROSS's example"))
