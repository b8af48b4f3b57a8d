"""What outlives a run lies in one folder, in files that nobody else reads."""

import stat

from uvf.runtime.state.state_folder import state_folder, write_private


def test_the_environment_chooses_the_folder(tmp_path):
    assert state_folder({"UVF_STATE": str(tmp_path)}) == tmp_path
    assert state_folder({}).name == "state"


def test_a_file_is_replaced_whole_and_only_its_owner_reads_it(tmp_path):
    path = tmp_path / "deep" / "key"
    for data in (b"one", b"another"):
        write_private(path, data)
        assert path.read_bytes() == data
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert [p.name for p in path.parent.iterdir()] == ["key"]


def test_one_that_others_could_read_is_private_from_then_on(tmp_path):
    path = tmp_path / "key"
    path.write_bytes(b"old")
    path.chmod(0o644)
    write_private(path, b"new")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
