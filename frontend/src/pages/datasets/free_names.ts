/** "KITTI", "KITTI 2", "KITTI 3", ... */
export function freeNames(name: string, count: number): string[] {
  const base = name.trim().slice(0, 190) || "Uploaded images";
  return Array.from({ length: count }, (_, index) => (index === 0 ? base : `${base} ${index + 1}`));
}
