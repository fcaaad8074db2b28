from __future__ import annotations

import io
import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from rich.console import Console

from app.commands.evaluate import Scoring, evaluate
from app.commands.reports import print_evaluation
from app.errors import InvalidFile, InvalidInput, NotFound
from app.formats.json_writer import write_json
from app.formats.label_npy import write_label_npy
from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz, write_npz_set
from app.vision.segments import Segments

YORK = Path(__file__).parents[2].parent / "shared" / "data" / "york"


def horizontal(y: float, length: int = 120) -> NDArray[np.float64]:
    return np.stack([np.arange(10.0, 11 + length), np.full(length + 1, y)], axis=1)


def save(path: Path, lines: list[NDArray[np.float64]], **fields) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    labelled = LabelledSegments(Segments.from_list(lines), **fields)
    match path.suffix:
        case ".npy":
            path.write_bytes(write_label_npy(labelled.segments))
        case ".npz":
            path.write_bytes(write_npz(labelled))
        case _:
            path.write_bytes(write_json(labelled))


def save_image(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(cv2.imencode(path.suffix, np.full((100, 160), 90, np.uint8))[1].tobytes())


@pytest.fixture
def folders(tmp_path: Path) -> Path:
    """Two images in a subfolder and one beside it, in all formats."""
    lines = [horizontal(20), horizontal(60)]
    save(tmp_path / "labels/KITTI/000000_edge_segments_filtered.npy", lines)
    save(tmp_path / "labels/KITTI/000001.npz", lines)
    save(tmp_path / "labels/other.json", lines)
    save(tmp_path / "found/KITTI/000000.npz", [horizontal(20)])
    save(tmp_path / "found/KITTI/000001.json", [horizontal(20), horizontal(90)])
    save(tmp_path / "found/other_edge_segments_filtered.npy", lines)
    (tmp_path / "found/prelabel.json").write_text("{}")
    return tmp_path


def read(path: Path) -> dict:
    return json.loads(path.read_text())


def test_folders_with_subfolders_in_all_formats(folders: Path) -> None:
    done = evaluate(folders / "labels", folders / "found", pictures=folders / "out/pictures")
    assert done.folder == folders / "out"
    assert done.evaluation.names == ("KITTI/000000", "KITTI/000001", "other")
    summary = read(folders / "out/summary.json")
    assert summary["protocol"] == "official-v1"
    assert summary["precision"] == pytest.approx((1 + 0.5 + 1) / 3, abs=1e-12)
    assert summary["recall"] == pytest.approx((0.5 + 0.5 + 1) / 3, abs=1e-12)
    assert (summary["images"], summary["missing"], summary["extra"]) == (3, [], [])
    assert (folders / "out/summary.txt").read_text().splitlines()[:4] == [
        "Results for Intersection over Union (IoU) of: 0.5",
        "Average Precision: 0.83",
        "Average Recall: 0.67",
        "F1 Score;: 0.74",
    ]
    one = read(folders / "out/individual_results/KITTI/000001.json")
    assert (one["precision"], one["recall"]) == (0.5, 0.5)
    assert one["label_outcomes"] == ["hit", "miss"]
    assert {path.name for path in (folders / "out").iterdir()} == {"summary.txt", "summary.json", "individual_results"}


def test_results_go_to_the_papers_place_by_default(folders: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folders)
    save_image(folders / "images/other.png")
    done = evaluate(Path("labels"), Path("found"), images=Path("images"))
    assert done.pictures == Path("evaluation/visualization")
    assert (folders / "evaluation/summary.txt").is_file()
    assert (folders / "evaluation/visualization/other.png").is_file()


def test_pictures_are_drawn_where_there_are_images(folders: Path) -> None:
    save_image(folders / "images/KITTI/000000.png")
    save_image(folders / "images/other.jpg")
    save_image(folders / "images/more/unlabelled.png")
    steps: list[tuple[int, int]] = []
    done = evaluate(
        folders / "labels",
        folders / "found",
        images=folders / "images",
        pictures=folders / "out/pictures",
        progress=lambda step, total: steps.append((step, total)),
    )
    pictures = sorted(path.relative_to(folders / "out/pictures").as_posix() for path in folders.rglob("out/**/*.png"))
    assert pictures == ["KITTI/000000.png", "other.png"]
    picture = cv2.imread(str(folders / "out/pictures/KITTI/000000.png"))
    assert picture is not None
    assert picture.shape[0] > 100
    blue, green, red = picture[20, 60].astype(int)
    assert green > blue + 80
    assert green > red + 80
    assert done.without_picture == ("KITTI/000001",)
    assert steps == [(step, 5) for step in range(1, 6)]


def test_a_broken_image_costs_its_picture_alone(folders: Path) -> None:
    save_image(folders / "images/other.png")
    (folders / "images/KITTI").mkdir()
    (folders / "images/KITTI/000000.png").write_bytes(b"no image")
    done = evaluate(folders / "labels", folders / "found", images=folders / "images", pictures=folders / "out/p")
    assert [error.where for error in done.picture_errors] == [str(folders / "images/KITTI/000000.png")]
    assert (folders / "out/p/other.png").is_file()
    assert read(folders / "out/summary.json")["images"] == 3


def test_missing_files_count_as_empty_and_extra_ones_are_named_all_at_once(folders: Path) -> None:
    (folders / "found/KITTI/000000.npz").unlink()
    (folders / "found/other_edge_segments_filtered.npy").unlink()
    save(folders / "found/z.npz", [horizontal(20)])
    save(folders / "found/KITTI/z.json", [horizontal(20)])
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    summary = read(folders / "out/summary.json")
    assert summary["missing"] == ["KITTI/000000", "other"]
    assert summary["extra"] == ["KITTI/z", "z"]
    assert summary["precision"] == pytest.approx(0.5 / 3, abs=1e-12)
    text = (folders / "out/summary.txt").read_text()
    assert all(name in text for name in ("- KITTI/000000", "- other", "- KITTI/z", "- z"))


def test_ambiguous_labels_are_ignored(folders: Path) -> None:
    save(folders / "labels/KITTI/000001_edge_segments_ambiguous.npy", [horizontal(90)])
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    one = read(folders / "out/individual_results/KITTI/000001.json")
    assert (one["precision"], one["recall"], one["predictions"]) == (1.0, 0.5, 1)
    assert [row["outcome"] for row in one["prediction_outcomes"]] == ["hit", "ignored"]
    assert read(folders / "out/summary.json")["counts"]["ignored_labels"] == 1


def test_an_image_may_have_ambiguous_labels_alone(folders: Path) -> None:
    save(folders / "labels/only_edge_segments_ambiguous.npy", [horizontal(90)])
    save(folders / "found/only.npz", [horizontal(20)])
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    one = read(folders / "out/individual_results/only.json")
    assert (one["labels"], one["precision"], one["recall"]) == (0, 0.0, None)


def test_of_labels_with_verdicts_those_kept_count(folders: Path) -> None:
    lines = [horizontal(20), horizontal(40), horizontal(60), horizontal(80), horizontal(90)]
    verdicts = ("keep", "reject", "undecided", None, "ambiguous")
    save(folders / "labels/other.json", lines, verdicts=verdicts)
    save(folders / "found/other_edge_segments_filtered.npy", lines)
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    one = read(folders / "out/individual_results/other.json")
    assert [row["outcome"] for row in one["prediction_outcomes"]] == [
        "hit",
        "false_alarm",
        "false_alarm",
        "false_alarm",
        "ignored",
    ]
    assert one["labels"] == 1


def test_labels_that_say_why_lines_are_rejected_tell_of_what_kind_wrong_lines_are(folders: Path) -> None:
    lines = [horizontal(20), horizontal(40), horizontal(60), horizontal(80)]
    verdicts, reasons = ("keep", "reject", "reject", "reject"), (None, "lane_marking", "shadow", None)
    save(folders / "labels/other.json", lines, verdicts=verdicts, reasons=reasons)
    save(folders / "found/other_edge_segments_filtered.npy", [lines[1], lines[0], lines[3]])
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p", scoring=Scoring("clearlines-v2"))
    one = read(folders / "out/individual_results/other.json")
    assert [row["rejected_as"] for row in one["prediction_outcomes"]] == ["lane_marking", None, None]
    marking, shadow = read(folders / "out/summary.json")["totals"]["strata"]["reason"]
    assert (marking["name"], marking["fp"], marking["candidates"]) == ("lane_marking", 1, 1)
    assert (shadow["name"], shadow["fp"], shadow["candidates"]) == ("shadow", 0, 1)
    text = (folders / "out/summary.txt").read_text()
    assert [line.split() for line in text.partition("found all the same:\n")[2].splitlines()[:2]] == [
        ["lane", "marking", "1.000", "[1.000,", "1.000]", "(1", "of", "1)"],
        ["shadow", "0.000", "[0.000,", "0.000]", "(0", "of", "1)"],
    ]


def test_short_lines_can_be_left_out(folders: Path) -> None:
    save(folders / "labels/other.json", [horizontal(20), horizontal(60, 40)])
    save(folders / "found/other_edge_segments_filtered.npy", [horizontal(80, 40), horizontal(20), horizontal(60, 60)])
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p", scoring=Scoring(min_length=50))
    one = read(folders / "out/individual_results/other.json")
    assert [(row["index"], row["outcome"]) for row in one["prediction_outcomes"]] == [(1, "hit"), (2, "ignored")]
    assert (one["precision"], one["recall"]) == (1.0, 1.0)


def test_one_file_may_hold_the_predictions_of_all_images(folders: Path) -> None:
    lines = LabelledSegments(Segments.from_list([horizontal(20)]))
    images = [(name, lines) for name in ("KITTI/000000", "KITTI/000001", "extra")]
    (folders / "all.npz").write_bytes(write_npz_set(images))
    evaluate(folders / "labels", folders / "all.npz", pictures=folders / "out/p")
    summary = read(folders / "out/summary.json")
    assert (summary["missing"], summary["extra"]) == (["other"], ["extra"])
    assert summary["counts"]["true_positives"] == 2


def test_all_broken_files_are_named_and_nothing_is_written(folders: Path) -> None:
    (folders / "found/KITTI/000001.json").write_text('{"segments": [{"points": [[1, NaN]]}]}')
    (folders / "labels/KITTI/000000_edge_segments_filtered.npy").write_bytes(b"not numpy")
    with pytest.raises(InvalidFile) as caught:
        evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    assert "000001.json" in str(caught.value)
    assert "000000_edge_segments_filtered.npy" in str(caught.value)
    assert not (folders / "out").exists()


def test_two_files_for_one_image_are_refused(folders: Path) -> None:
    save(folders / "found/KITTI/000000.json", [horizontal(20)])
    with pytest.raises(InvalidInput, match=r"found: .*KITTI/000000\.json and KITTI/000000\.npz"):
        evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")


def test_a_folder_that_is_not_there_is_named(folders: Path) -> None:
    for arguments in ((folders / "nope", folders / "found"), (folders / "labels", folders / "nope")):
        with pytest.raises(NotFound, match=r"nope: the .* folder doesn't exist"):
            evaluate(*arguments, pictures=folders / "out/p")
    with pytest.raises(NotFound, match="image folder"):
        evaluate(folders / "labels", folders / "found", images=folders / "nope", pictures=folders / "out/p")


def test_no_labels_say_what_was_looked_for(folders: Path) -> None:
    (folders / "empty").mkdir()
    with pytest.raises(InvalidInput, match=r"no label files.*NAME_edge_segments_filtered\.npy"):
        evaluate(folders / "empty", folders / "found", pictures=folders / "out/p")


@pytest.mark.parametrize("min_length", [-1.0, float("nan"), float("inf")])
def test_a_senseless_length_is_refused(folders: Path, min_length: float) -> None:
    with pytest.raises(InvalidInput, match="length"):
        evaluate(
            folders / "labels", folders / "found", pictures=folders / "out/p", scoring=Scoring(min_length=min_length)
        )


def test_an_unknown_protocol_is_refused(folders: Path) -> None:
    with pytest.raises(InvalidInput, match="official-v1"):
        evaluate(folders / "labels", folders / "found", pictures=folders / "out/p", scoring=Scoring(protocol="mine"))


@pytest.mark.parametrize("protocol", ["official-v1-fixed", "clearlines-v2"])
def test_the_result_can_be_stated_under_each_protocol(folders: Path, protocol: str) -> None:
    save_image(folders / "images/KITTI/000001.png")
    done = evaluate(
        folders / "labels",
        folders / "found",
        images=folders / "images",
        pictures=folders / "out/p",
        scoring=Scoring(protocol, draws=50),
    )
    summary = read(folders / "out/summary.json")
    assert summary["protocol"] == protocol
    # 6 labels, 5 predictions, 4 of them right
    assert (summary["precision"], summary["recall"]) == pytest.approx((4 / 5, 4 / 6))
    assert summary["f1"] == done.evaluation.f1 == pytest.approx(8 / 11)
    assert (folders / "out/summary.txt").read_text().splitlines()[1:4] == [
        "Precision: 0.80",
        "Recall: 0.67",
        "F1 Score: 0.73",
    ]
    one = read(folders / "out/individual_results/KITTI/000001.json")
    assert [row["outcome"] for row in one["prediction_outcomes"]] == ["hit", "false_alarm"]
    assert ("error_type" in one["prediction_outcomes"][0]) == (protocol == "clearlines-v2")
    assert (folders / "out/p/KITTI/000001.png").is_file()


def test_draws_and_seed_move_intervals_alone(folders: Path) -> None:
    found = []
    for seed in (0, 0, 1):
        evaluate(folders / "labels", folders / "found", pictures=folders / "out/p", scoring=Scoring(draws=7, seed=seed))
        totals = read(folders / "out/summary.json")["totals"]
        assert totals["draws"] == 7
        found.append(totals["protocols"]["clearlines-v2"]["totals"]["mean_liou"])
    assert found[0] == found[1]
    assert found[0]["value"] == found[2]["value"]


@pytest.mark.parametrize("draws", [0, -1, 10**9])
def test_a_senseless_number_of_draws_is_refused(draws: int) -> None:
    with pytest.raises(InvalidInput, match="draws"):
        Scoring(draws=draws)


def test_the_tables_beside_the_images_say_source_sequence_and_camera(folders: Path) -> None:
    for name in ("KITTI/000000", "KITTI/000001", "other", "unlabelled"):
        save_image(folders / f"data/images/{name}.png")
    table = (
        "name,camera,source,sequence\nKITTI/000000,left,KITTI raw,7\nKITTI/000001.png,left,KITTI raw,7\nunlabelled,,,\n"
    )
    (folders / "data/images.csv").write_text(table)
    K = [[150, 0, 80], [0, 150, 50], [0, 0, 1]]
    (folders / "data/cameras.json").write_text(
        json.dumps({"left": {"width": 160, "height": 100, "K": K, "D": [0.1, 0, 0, 0]}})
    )
    evaluate(folders / "labels", folders / "found", images=folders / "data/images", pictures=folders / "out/p")
    totals = read(folders / "out/summary.json")["totals"]
    assert (totals["images"], totals["clusters"]) == (3, 2)
    assert [(stratum["name"], stratum["images"]) for stratum in totals["strata"]["source"]] == [
        ("KITTI raw", 2),
        ("unknown", 1),
    ]
    assert [(camera["camera"], camera["images"]) for camera in totals["cameras"]] == [("160x100", 1), ("left", 2)]
    assert totals["cameras"][0]["grid"] is None
    assert totals["cameras"][1]["grid"] > 0


def test_without_images_a_folder_is_the_source_and_no_camera_is_known(folders: Path) -> None:
    evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    totals = read(folders / "out/summary.json")["totals"]
    assert [stratum["name"] for stratum in totals["strata"]["source"]] == ["KITTI", "unknown"]
    assert "distance" not in totals["strata"]
    assert totals["cameras"] == []


def test_the_table_has_the_scores_by_source(folders: Path) -> None:
    done = evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    assert [(row.source, row.images, row.precision) for row in done.table] == [
        ("KITTI", 2, 0.75),
        (None, 1, 1.0),
        ("all", 3, pytest.approx(2.5 / 3)),
    ]
    shown = io.StringIO()
    print_evaluation(done, Console(file=shown, soft_wrap=True), table=True)
    assert "KITTI             2  0.75  0.50  0.60" in shown.getvalue()
    assert "Average Precision" not in shown.getvalue()


def test_a_second_time_replaces_the_first(folders: Path) -> None:
    for _ in range(2):
        evaluate(folders / "labels", folders / "found", pictures=folders / "out/p")
    assert not list(folders.rglob("*.tmp"))
    assert read(folders / "out/summary.json")["images"] == 3


def test_york_labels_against_themselves_and_with_pictures(tmp_path: Path) -> None:
    labels = sorted(YORK.glob("labels/*.npy"))[:3]
    if not labels:
        pytest.skip("the York Urban photos aren't there")
    for path in labels:
        (tmp_path / "labels").mkdir(exist_ok=True)
        (tmp_path / "labels" / path.name).write_bytes(path.read_bytes())
    done = evaluate(tmp_path / "labels", YORK / "labels", images=YORK / "images", pictures=tmp_path / "out/p")
    assert done.evaluation.precision == 1.0
    assert done.without_picture == ()
    assert len(done.evaluation.extra) == len(sorted(YORK.glob("labels/*.npy"))) - 3
    assert len(list((tmp_path / "out/p").glob("*.png"))) == 3
