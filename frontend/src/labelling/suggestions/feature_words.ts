/** What the features of a candidate are called: where a suggestion says why, and where a model's weights are listed. */

interface Words {
  /** Reads well whichever way it speaks: "for it: straightness, contrast". */
  readonly reason: string;
  /** What there is more of, the larger the number. */
  readonly quantity: string;
}

function words(reason: string, quantity: string): Words {
  return { reason, quantity };
}

/** By the names that the server gives. */
export const FEATURE_WORDS: Readonly<Record<string, Words>> = {
  length: words("length", "Length in image diagonals"),
  "length in px": words("length", "Length"),
  score: words("edge strength", "Edge score"),
  straightness: words("straightness", "Straightness under the lens"),
  residual: words("straightness", "Deviation from straight"),
  "residual over length": words("straightness", "Deviation for its length"),
  "points per px": words("gaps in it", "Edge points per px"),
  "chord over arc": words("straightness", "Directness"),
  "across the frame": words("place in the image", "Distance from the middle column"),
  "down the frame": words("height in the image", "Depth down the image"),
  "to the border": words("place in the image", "Distance to the border"),
  "ends at the border": words("ends at the border", "Ends at the border"),
  upright: words("direction", "Steepness"),
  "from the centre": words("place in the image", "Distance from the centre"),
  "vanishing deviation": words("vanishing point", "Deviation from a vanishing point"),
  "second vanishing deviation": words("vanishing point", "Deviation from the next vanishing point"),
  "upright deviation": words("verticals of the scene", "Deviation from the scene's verticals"),
  "vanishing support": words("vanishing point", "Lines with its vanishing point"),
  "upright family": words("verticals of the scene", "One of the scene's verticals"),
  "all support": words("regular scene", "Lines with a vanishing point"),
  "length pointing along": words("lines alike in direction", "Lines in its direction in space"),
  "double of a longer one": words("doubles", "Double of a longer line"),
  "double of a better one": words("doubles", "Double of a better line"),
  doubles: words("doubles", "Doubles"),
  "parallel distance": words("parallel beside it", "Distance to a parallel"),
  "parallel length": words("parallel beside it", "Length of its parallel"),
  "parallel score": words("parallel beside it", "Score of its parallel"),
  "longer parallel distance": words("parallel beside it", "Distance to a longer parallel"),
  "parallels near": words("parallels around", "Parallels near by"),
  "parallels around": words("parallels around", "Parallels around"),
  "parallel length around": words("parallels around", "Length of parallels around"),
  "continuation gap": words("continuation", "Gap to its continuation"),
  "continuation length": words("continuation", "Length of its continuation"),
  corners: words("corners", "Corners with others"),
  crossings: words("crossings", "Crossings"),
  "direction share": words("lines alike in direction", "Share of lines in its direction"),
  density: words("lines around", "Lines around"),
  "score around": words("lines around", "Scores of lines around"),
  contrast: words("contrast", "Contrast"),
  "contrast evenness": words("evenness of contrast", "Unevenness of contrast"),
  "weakest contrast": words("contrast", "Its weakest contrast"),
  polarity: words("constant bright side", "Constancy of its bright side"),
  "wide contrast": words("contrast", "Contrast seen wider"),
  "edge sharpness": words("sharpness", "Sharpness"),
  "side texture": words("texture beside it", "Texture beside it"),
  "rougher side": words("texture beside it", "Texture of its rougher side"),
  "side difference": words("its two sides", "Difference of its sides"),
  brightness: words("brightness", "Brightness"),
  bar: words("thin bar", "Looks like a thin bar"),
  "goes on beyond start": words("how it ends", "Edge goes on past its start"),
  "goes on beyond end": words("how it ends", "Edge goes on past its end"),
  "local gradient": words("edges around", "Strength of edges around"),
  "local coherence": words("edges around", "Order of edges around"),
  "local alignment": words("edges around", "Agreement with edges around"),
  "near gradient share": words("edges around", "Share of edges close by"),
  "length rank": words("length", "Length among the image's"),
  "score rank": words("edge strength", "Score among the image's"),
  "length against the image's": words("length", "Length against the image's"),
  "score against the image's": words("edge strength", "Score against the image's"),
  "contrast against the image's": words("contrast", "Contrast against the image's"),
  "vanishing deviation rank": words("vanishing point", "Deviation from a vanishing point, ranked"),
  candidates: words("number of candidates", "Candidates of the image"),
  "typical score": words("the image as a whole", "Typical score of the image"),
  "frames before and after": words("frames beside", "Found in the frames beside"),
};

/** Several features as one phrase, each thing said once. */
export function reasonPhrase(features: readonly string[], most = features.length): string {
  const reasons = features.map((feature) => FEATURE_WORDS[feature]?.reason ?? feature);
  return [...new Set(reasons)].slice(0, most).join(", ");
}

/** What a model's weight is about. */
export function quantityOf(feature: string): string {
  return FEATURE_WORDS[feature]?.quantity ?? feature;
}
