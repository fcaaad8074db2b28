"""Which store the settings choose, and what is said of an address that can't be used."""

import subprocess
import sys
import traceback
from contextlib import closing
from pathlib import Path

import pytest

from app.errors import InvalidInput, Unavailable
from app.settings import Settings
from app.storage import LocalBlobs, RemoteBlobs, open_blobs, open_blobs_at
from app.storage.refusals import reason_of, refusal, secrets_in, shown_address

SECRET = "wJalrXUtnFEMI"


def test_without_an_address_blobs_lie_in_the_data_folder(tmp_path: Path) -> None:
    store = open_blobs(Settings(data_dir=tmp_path))
    assert isinstance(store, LocalBlobs)
    assert store.address == str(tmp_path / "blobs")


@pytest.mark.parametrize("form", ["{}", "file://{}", "local://{}"])
def test_a_folder_of_this_machine_is_used_as_such(tmp_path: Path, form: str) -> None:
    folder = tmp_path / "some blobs"
    store = open_blobs_at(form.format(folder).replace(" ", "%20" if "://" in form else " "), folder=tmp_path / "data")
    assert isinstance(store, LocalBlobs)
    assert store.root == folder


def test_any_other_address_is_one_of_fsspec(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path, blob_url="memory://blobs/here", blob_options={"global_store": False})
    with closing(open_blobs(settings)) as store:
        assert isinstance(store, RemoteBlobs)
        assert store.address == "memory://blobs/here"
        store.check()
        assert store.read(store.put(b"content")) == b"content"
    with closing(open_blobs(settings)) as another:
        assert list(another.iterate()) == []  # no file system is shared


@pytest.mark.parametrize(
    ("url", "options", "what"),
    [
        ("nowhere://bucket", {}, "Protocol not known"),
        ("s3://", {}, "names no bucket"),
        ("memory://", {}, "names no bucket"),
        ("s3://bucket", {"key": "a", "username": "b"}, "not both"),
    ],
)
def test_an_address_that_means_nothing_is_told(tmp_path: Path, url: str, options: dict[str, str], what: str) -> None:
    with pytest.raises(InvalidInput, match=what) as caught:
        open_blobs_at(url, options, folder=tmp_path)
    assert "s3://BUCKET/PREFIX" in str(caught.value)


@pytest.mark.parametrize("url", ["file://srv/blobs", "file://", "://bucket"])
def test_a_folder_of_another_machine_is_refused(tmp_path: Path, url: str) -> None:
    with pytest.raises(InvalidInput, match="no address of a folder"):
        open_blobs_at(url, folder=tmp_path)


def test_what_is_missing_for_an_address_is_named(tmp_path: Path) -> None:
    program = f"""
import sys
sys.modules["s3fs"] = None
from pathlib import Path
from app.storage import open_blobs_at
from app.errors import InvalidInput
for url in ("s3://bucket", "gs://bucket"):
    try:
        open_blobs_at(url, folder=Path({str(tmp_path)!r}))
    except InvalidInput as error:
        print(error)
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    s3, gs = run.stdout.splitlines()
    assert s3 == "s3://bucket: what s3:// needs isn't installed; hint: pip install 'clearlines[s3]'"
    assert "gcsfs" in gs


def test_an_option_that_the_file_system_does_not_know_is_told(tmp_path: Path, caplog) -> None:
    options = {"secrt": SECRET, "endpoint_url": "http://127.0.0.1:9"}
    with (
        closing(open_blobs_at("s3://bucket", options, folder=tmp_path)) as store,
        pytest.raises(Unavailable, match="can't be used") as caught,
    ):
        store.check()
    assert "secrt" in caplog.text
    assert SECRET not in "".join(traceback.format_exception(caught.value)) + caplog.text


def test_addresses_are_shown_without_what_nobody_may_see() -> None:
    assert shown_address("s3://bucket/a/b") == "s3://bucket/a/b"
    assert shown_address(f"sftp://user:{SECRET}@host:22/blobs?token={SECRET}#x") == "sftp://host:22/blobs"


def test_secrets_are_struck_out_of_what_others_say(caplog) -> None:
    options = {
        "key": "AKIA",
        "client_kwargs": {"aws_secret_access_key": SECRET, "endpoint_url": "http://objects:9000"},
        "several": [{"token": SECRET + "longer"}],
        "anon": False,
        "short": "x",
    }
    secrets = secrets_in(options)
    assert secrets == {"AKIA", SECRET, SECRET + "longer"}
    said = OSError(f"http://user:{'pass'}@objects:9000 says AKIA\n with {SECRET}longer and {SECRET} is wrong")
    assert reason_of(said, secrets) == "OSError: http://***@objects:9000 says *** with *** and *** is wrong"
    for error in (PermissionError(SECRET), TimeoutError(SECRET), ValueError(SECRET), OSError(SECRET)):
        told = refusal(error, "s3://bucket", secrets)
        assert told.status == 503
        assert SECRET not in str(told) + caplog.text
        assert told.hint
    assert len(caplog.records) == 4
