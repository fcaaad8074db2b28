import "react";

declare module "react" {
  interface InputHTMLAttributes<T> {
    /** Lets a file input choose a folder; every browser knows it, the HTML standard doesn't. */
    webkitdirectory?: "";
  }
}
