"""Names that nobody can tell apart, and names that stand on what others did."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime

import pytest

from app.db.models import Blob, Camera, Dataset, Image, ImagePerson, Review, User
from app.db.session import Database
from app.errors import Conflict, InvalidInput
from app.services.account_names import checked_account_name, require_free_name

Add = Callable[..., User]


@pytest.mark.parametrize(
    "name",
    ["alice\u3164", "al\u034fice", "alice\ufe0f", "ali\u115fce", "alice\u180b", "alice\u17b4", "\u2800", "\U000e0101a"],
)
def test_what_nobody_sees_is_no_part_of_a_name(name: str) -> None:
    assert name.isprintable()
    with pytest.raises(InvalidInput):
        checked_account_name(name)


@pytest.mark.parametrize("name", ["Ada", "Zoë", "李雷", "Мария", "محمد", "한글", "नेहा", "O’Neill", "José-María"])
def test_names_of_all_scripts_stay_as_they_are(name: str) -> None:
    assert checked_account_name(name) == name


def test_a_name_that_stands_on_a_verdict_is_given_by_an_admin_and_taken_by_nobody(
    database: Database, add: Add, now: datetime
) -> None:
    with database.write() as session:
        dataset = Dataset(slug="street", name="Street", created_at=now)
        session.add_all([dataset, Blob(sha256="0" * 64, size=1, media_type="image/png", created_at=now)])
        session.flush()
        camera = Camera(dataset_id=dataset.id, name="front", width=8, height=8, created_at=now)
        size = {"width": 8, "height": 8, "bits": 8}
        image = Image(
            dataset_id=dataset.id, name="a", file_name="a.png", sha256="0" * 64, camera=camera, created_at=now, **size
        )
        image.review = Review(status="open", updated_at=now)
        session.add(image)
        session.flush()
        session.add(ImagePerson(image_id=image.id, person="Mara"))
    with database.read() as session:
        with pytest.raises(Conflict, match="taken"):
            require_free_name(session, "mara", chosen=True)
        require_free_name(session, "Bo", chosen=True)
    assert add(database, "Mara").name == "Mara"
