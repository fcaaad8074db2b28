/** The page's one hint book. */

import { HintBook } from "./hint_book";

export const hintBook = new HintBook(localStorage);
