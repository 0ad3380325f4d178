"""Models of other programs, as they are: what is counted in them, and a blend between two of their faces."""

import pytest

from semispline import Base, blend, list_surfaces, read_surface

# File, faces, and how many of them are rational and trimmed, as the list that comes with the folder has it.
MODELS = [
    ("build123d_M6-1x12-countersunk-screw.step", 28, 14, 28),
    ("cadquery_red_cube_blue_cylinder.step", 9, 1, 2),
    ("demos_as1_pe_203.stp", 160, 70, 50),
    ("demos_face_recognition_sample_part.stp", 23, 6, 8),
    ("demos_splinecage.stp", 4, 0, 0),
    ("occt_bottle.brep", 71, 56, 9),
    ("occt_screw.step", 10, 6, 8),
    ("occt_shell1.brep", 99, 0, 13),
    ("tigl_simplewing.brep", 8, 0, 2),
    ("v3_T-Joint2.3dm", 18, 16, 11),
    ("v4_DinerMug.3dm", 4, 1, 2),
    ("v4_MechPartA.3dm", 41, 27, 33),
    ("v4_SolidHandle.3dm", 37, 25, 27),
]


# One of each format in `make test`: most of the time goes into starting the kernel.
QUICK = ("build123d_M6-1x12-countersunk-screw.step", "demos_as1_pe_203.stp", "occt_shell1.brep", "v4_SolidHandle.3dm")


@pytest.mark.usefixtures("read_here")
@pytest.mark.parametrize(
    ("name", "faces", "rational", "trimmed"),
    [pytest.param(*model, marks=[] if model[0] in QUICK else pytest.mark.slow) for model in MODELS],
)
def test_faces_of_a_model(shared, name, faces, rational, trimmed):
    found = list_surfaces(shared / "data" / "cad" / name)
    assert (len(found), sum(e.rational for e in found), sum(e.trimmed for e in found)) == (faces, rational, trimmed)


@pytest.mark.long
@pytest.mark.usefixtures("read_here")
def test_two_faces_of_a_model_are_joined(shared):
    model = shared / "data" / "v4_SaltAndPepper.3dm"
    result = blend(Base(read_surface(f"{model}#0"), "u1"), Base(read_surface(f"{model}#54"), "u0"), continuity="G2")
    assert result.contact_a.angle_degrees < 1e-9
    assert result.contact_b.angle_degrees < 1e-9
