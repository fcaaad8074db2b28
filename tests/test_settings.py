from __future__ import annotations

from datetime import timedelta
from pathlib import Path

import pytest
from pydantic import ValidationError

from app.db.session import open_database, upgrade
from app.settings import Settings


def test_everything_lies_in_the_data_folder(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path)
    assert str(settings.database_address) == f"sqlite:///{tmp_path}/clearlines.sqlite3"
    assert settings.blob_dir == tmp_path / "blobs"
    assert settings.grace == timedelta(days=7)


def test_a_folder_of_any_name_holds_a_database(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data of ü 100% ?#")
    database = open_database(settings.database_address)
    upgrade(database)
    database.close()
    assert (settings.data_dir / "clearlines.sqlite3").is_file()


def test_the_environment_sets_every_knob(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name, value in (("DATA_DIR", str(tmp_path)), ("DATABASE_URL", "postgresql://x@y/z"), ("WORKERS", "3")):
        monkeypatch.setenv(f"CLEARLINES_{name}", value)
    settings = Settings()
    assert (settings.data_dir, settings.database_address, settings.workers) == (tmp_path, "postgresql://x@y/z", 3)


@pytest.mark.parametrize(
    "wrong", [{"workers": 0}, {"grace_days": -1}, {"port": 70_000}, {"person": ""}, {"nonsense": 1}]
)
def test_values_that_can_not_be(wrong: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        Settings(**wrong)


def test_every_knob_is_described() -> None:
    assert [name for name, field in Settings.model_fields.items() if not field.description] == []
