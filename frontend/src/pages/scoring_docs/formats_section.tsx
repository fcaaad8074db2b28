import { CopyButton } from "../../design/copy_button";

const PER_IMAGE_JSON = `{"segments": [
  {"points": [[102.5, 40.0], [103.1, 41.0], [104.0, 42.0]], "score": 0.93},
  {"points": [[310.0, 12.0], [310.2, 200.0]]}
]}`;

const FOR_ALL_JSON = `{"images": {
  "KITTI/000000": {"segments": [{"points": [[102.5, 40.0], [103.1, 41.0]]}]},
  "KITTI/000001": {"segments": []}
}}`;

const WRITE_NPZ = `import numpy as np

lines = [np.array([[102.5, 40.0], [103.1, 41.0]], np.float32)]  # x right, y down, px
np.savez(
    "KITTI/000000.npz",
    points=np.concatenate(lines),
    offsets=np.cumsum([0, *map(len, lines)]),  # segment s is points[offsets[s]:offsets[s + 1]]
    scores=np.array([0.93], np.float32),  # may be left out
)`;

/** The forms in which results are taken, with examples to copy. */
export function FormatsSection() {
  const server = window.location.origin;
  const images = `import httpx
from pathlib import Path

server, cursor = "${server}", None
while True:
    page = httpx.get(f"{server}/api/splits/SPLIT/images", params={"cursor": cursor} if cursor else {}).json()
    for image in page["items"]:
        path = Path("images", image["name"])
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(httpx.get(server + image["original"]).content)  # as it was uploaded
    cursor = page["next_cursor"]
    if cursor is None:
        break`;
  const python = `import httpx

answer = httpx.post(
    "${server}/api/splits/SPLIT/submissions",
    headers={"Authorization": "Bearer cl_..."},
    data={"method": "My detector", "label": "v1"},
    files={"files": open("results.zip", "rb")},
)
answer.raise_for_status()
print(answer.json()["id"], answer.json()["status"])`;
  return (
    <section className="scoring-docs__section" aria-labelledby="formats">
      <h2 id="formats">Formats</h2>
      <p>
        One zip or tar.gz with a file per image, the files themselves, or one file for all images. A file is
        named like its image, with folders and without the image's ending: <code>KITTI/000000.npz</code>.
        Points are in px, x to the right, y down, the first pixel's centre at (0, 0). An image without a file
        counts as one where nothing was found.
      </p>
      <Example title="npz per image" text={WRITE_NPZ} />
      <Example title="JSON per image" text={PER_IMAGE_JSON} />
      <Example title="One JSON for all images" text={FOR_ALL_JSON} />
      <p>
        One npz for all images has <code>names</code>, <code>image_offsets</code>, <code>offsets</code>,{" "}
        <code>points</code> and, if there are any, <code>scores</code>. The object arrays of the paper's tools
        (<code>.npy</code>) are read too; nothing that is sent is ever executed.
      </p>
      <Example title="The images of a split" text={images} />
      <Example
        title="From a shell"
        text={`clearlines submit --server ${server} --split SPLIT --method "My detector" results/`}
      />
      <Example title="From Python" text={python} />
    </section>
  );
}

function Example({ title, text }: { title: string; text: string }) {
  return (
    <div className="example">
      <h3>{title}</h3>
      <div className="example__text">
        <pre className="mono">{text}</pre>
        <CopyButton text={text} label={`Copy: ${title}`} />
      </div>
    </div>
  );
}
