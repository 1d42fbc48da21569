"""Meshes that move, by Python."""

import importlib.util
import pathlib

import numpy as np
import pytest

import ductile


def disc_in_square(n=24, centre=(0.3, 0.5), radius=0.15):
    """Triangles of a square; those within a polygon are region 3, the others 2."""
    x = np.linspace(0, 1, n + 1)
    points = np.stack(np.meshgrid(x, x, indexing="ij"), -1).reshape(-1, 2)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    a, b, c, d = corner, corner + n + 1, corner + n + 2, corner + 1
    cells = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    middle = points[cells].mean(1)
    refs = np.where(np.linalg.norm(middle - centre, axis=1) < radius, 3, 2)
    return ductile.Mesh(points, cells, refs=refs).remesh(hsiz=1 / n)


def areas(mesh):
    p = mesh.points[mesh.cells]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def by(mesh, vector, ref=3):
    u = np.zeros_like(mesh.points)
    u[np.unique(mesh.cells[mesh.refs == ref])] = vector
    return u


def test_a_body_moves_and_the_rest_follows():
    mesh = disc_in_square()
    new = mesh.move(by(mesh, [0.4, 0.05]), bodies=[3])
    assert not new.check() and new.report.share == 1 and new.report.adaptations > 0
    body, was = areas(new)[new.refs == 3], areas(mesh)[mesh.refs == 3]
    assert abs(body.sum() / was.sum() - 1) < 1e-9 and abs(areas(new).sum() - 1) < 1e-9
    assert new.quality().min() > 0.3
    np.testing.assert_array_equal(new.metric.shape, (len(new.points), 3))


def test_many_calls_take_the_metric_along():
    mesh = disc_in_square()
    total = areas(mesh)[mesh.refs == 3].sum()
    mesh = mesh.move(by(mesh, [0.02, 0]), metric=0.04)
    for _ in range(15):
        mesh = mesh.move(by(mesh, [0.02, 0]), metric=mesh.metric)
    assert abs(areas(mesh)[mesh.refs == 3].sum() / total - 1) < 1e-9
    assert mesh.quality().min() > 0.2


@pytest.mark.parametrize("conservative", [False, True])
def test_fields_go_along(conservative):
    mesh = disc_in_square()
    rng = np.random.default_rng(1)
    fields = {"u": rng.random((len(mesh.points), 2)), "e": rng.random(len(mesh.cells))}
    new = mesh.move(by(mesh, [0.3, 0]), fields=fields, conservative=conservative)
    assert new.fields["u"].shape == (len(new.points), 2)
    assert new.cell_fields["e"].shape == (len(new.cells),)
    if conservative:
        before, after = areas(mesh), areas(new)
        assert abs(after @ new.cell_fields["e"] - before @ fields["e"]) < 1e-12
        mean = lambda m, u: u[m.cells].mean(1)
        np.testing.assert_allclose(after @ mean(new, new.fields["u"]),
                                   before @ mean(mesh, fields["u"]), rtol=0, atol=1e-12)
    else:
        assert set(new.cell_fields["e"]) <= set(fields["e"])


def test_a_blocked_way_says_how_far_it_went():
    mesh = disc_in_square()
    with pytest.raises(ductile.Error, match=r"stopped at \d.* % of it because a triangle at \("):
        mesh.move(by(mesh, [-0.3, 0]))
    part = mesh.move(by(mesh, [-0.3, 0]), keep_partial=True)
    assert 0.2 < part.report.share < 0.52 and part.report.stopped and not part.check()


def test_wrong_arguments_are_named():
    mesh = disc_in_square(6)
    u = np.zeros_like(mesh.points)
    for call, text in [(lambda: mesh.move(u[:3]), "displacement: expected shape"),
                       (lambda: mesh.move(u * np.nan), "displacement"),
                       (lambda: mesh.move(u, bodies=[9]), "bodies: expected references"),
                       (lambda: mesh.move(u, boundaries=[9]), "boundaries: expected references"),
                       (lambda: mesh.move(u, fields={"a": [1, 2]}), "a: expected a row")]:
        with pytest.raises(ductile.InputError, match=text):
            call()


def test_origins_lead_to_the_mesh_before():
    mesh = disc_in_square()
    new = mesh.move(by(mesh, [0.3, 0]), bodies=[3], fields={"place": mesh.points})
    kept = new.origin.vertices >= 0
    assert new.report.adaptations > 0 and 0.3 < kept.mean() < 1
    body = np.unique(new.cells[new.refs == 3])
    np.testing.assert_allclose(new.points[body], mesh.points[new.origin.vertices[body]] + [0.3, 0])
    hosts = mesh.points[mesh.cells[new.origin.host]]
    np.testing.assert_allclose(np.einsum("nc,ncd->nd", new.origin.weights, hosts),
                               new.fields["place"], atol=1e-12)
    old = new.origin.cells >= 0
    np.testing.assert_array_equal(new.refs[old], mesh.refs[new.origin.cells[old]])


def test_directions_turn_if_asked():
    mesh = disc_in_square(centre=(0.5, 0.5))
    c, s = np.cos(1), np.sin(1)
    quarter = np.array([[c, s], [-s, c]])
    u = by(mesh, (mesh.points @ quarter + 0.5 - [0.5, 0.5] @ quarter - mesh.points)[np.unique(
        mesh.cells[mesh.refs == 3])])
    fibre = np.tile([2.0, 0.5], (len(mesh.cells), 1))
    new = mesh.move(u, bodies=[3], fields={"fibre": fibre, "still": fibre}, turned=["fibre"])
    inside = new.refs == 3
    np.testing.assert_allclose(new.cell_fields["fibre"][inside], (fibre @ quarter)[:inside.sum()])
    np.testing.assert_array_equal(new.cell_fields["still"], fibre[:len(new.cells)])
    with pytest.raises(ductile.InputError, match="turned: expected names"):
        mesh.move(u, fields={"fibre": fibre}, turned=["fiber"])


@pytest.fixture(scope="module")
def example():
    pytest.importorskip("scipy")
    path = pathlib.Path(__file__).parent.parent / "examples" / "turning_body.py"
    spec = importlib.util.spec_from_file_location("turning", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_example_turns_its_body(example, tmp_path, capsys):
    mesh, velocity = example.main(6, str(tmp_path / "flow"), n=20, dt=0.25)
    assert mesh.check() == [] and (tmp_path / "flow_1.svg").exists()
    body = mesh.points[np.unique(mesh.cells[mesh.refs == 3])] - example.CENTRE
    angle = example.TURN * 6 * 0.25
    long = body @ [np.cos(angle), np.sin(angle)]
    assert abs(np.ptp(long) / (2 * example.AXES[0]) - 1) < 0.02  # it lies along the turned axis
    # What comes in on the left goes out on the right.
    out = np.flatnonzero(mesh.points[:, 0] > example.LENGTH - 1e-9)
    out = out[np.argsort(mesh.points[out, 1])]
    y, speed = mesh.points[out, 1], velocity[out, 0]
    flux = (np.diff(y) * (speed[1:] + speed[:-1]) / 2).sum()
    assert abs(flux / example.HEIGHT - 1) < 0.02
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 6 and np.abs(velocity).max() < 4
    assert all(float(line.split("quality ")[1].split(",")[0]) > 0.1 for line in lines)


def test_the_flow_of_the_example_stays_uniform_without_a_body(example, monkeypatch):
    """However the mesh moves."""
    mesh = disc_in_square(16)
    monkeypatch.setattr(example, "LENGTH", 1)
    monkeypatch.setattr(example, "HEIGHT", 1)
    mesh_velocity = np.random.default_rng(2).normal(size=mesh.points.shape)
    uniform = np.tile([1.0, 0.0], (len(mesh.points), 1))
    fluid = ductile.Mesh(mesh.points, mesh.cells, refs=np.where(mesh.refs == 3, 2, mesh.refs))
    velocity, _ = example.flow(fluid, uniform, mesh_velocity, 0.1)
    np.testing.assert_allclose(velocity, uniform, atol=1e-9)
