/** Lengths and other numbers of lenses as people read them. */

/** "0.042 px", "0.42 px", "12.3 px", "312 px": about three digits. */
export function px(length: number | null | undefined): string {
  return length === null || length === undefined || !Number.isFinite(length)
    ? "not known"
    : `${digits(length)} px`;
}

/** A number with about three digits and a true minus sign. */
export function digits(value: number): string {
  const size = Math.abs(value);
  const places = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.0995 ? 2 : 3;
  return value
    .toFixed(places)
    .replace(/^-(?=.*[1-9])/, "−")
    .replace(/^-/, "");
}

/** A coefficient with the digits that its uncertainty leaves standing: "−0.3712 ± 0.0008". */
export function withSigma(value: number, sigma: number | undefined): string {
  if (sigma === undefined || !(sigma > 0)) return signed(value.toPrecision(4));
  const places = Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(sigma))));
  return `${signed(value.toFixed(places))} ± ${sigma.toFixed(places)}`;
}

function signed(text: string): string {
  return text.replace(/^-/, "−");
}
