/** Nothing is said of an image that is there at once: the notice fades in. */
export function LoadingNotice() {
  return (
    <div className="banner loading-notice" role="status">
      <span className="spinner" aria-hidden="true" />
      <span>Loading the image</span>
    </div>
  );
}
