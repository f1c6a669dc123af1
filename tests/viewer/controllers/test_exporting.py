"""Files are written whole or not at all."""

import pytest

from add_viewer.controllers.exporting import write_atomically


def test_a_failed_write_leaves_the_old_file_and_no_rubbish(tmp_path):
    path = tmp_path / "picture.png"
    path.write_text("precious")

    def write(temporary):
        temporary.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        write_atomically(path, write)
    assert path.read_text() == "precious"
    assert [each.name for each in tmp_path.iterdir()] == ["picture.png"]


def test_the_temporary_file_has_the_ending_that_decides_the_format(tmp_path):
    path = tmp_path / "curves.svg"
    seen = []
    write_atomically(path, lambda temporary: (seen.append(temporary.suffix), temporary.write_text("new")))
    assert seen == [".svg"]
    assert path.read_text() == "new"


def test_a_folder_that_does_not_exist_is_an_error(tmp_path):
    with pytest.raises(OSError, match=r"."):
        write_atomically(tmp_path / "none" / "x.png", lambda temporary: temporary.write_text(""))


def test_a_file_that_cannot_be_written_is_called_by_its_own_name(tmp_path):
    def fill_the_disk(temporary):
        raise OSError(28, "No space left on device", str(temporary))

    for path, write in ((tmp_path / "none" / "x.png", print), (tmp_path / "x.png", fill_the_disk)):
        with pytest.raises(OSError, match=r"\[Errno") as caught:
            write_atomically(path, write)
        assert caught.value.filename == str(path)
