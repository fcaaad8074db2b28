import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Application } from "./app/application";
import { startPalette } from "./design/palette";
import { startTheme } from "./design/theme";
import { outbox } from "./labelling/outbox_start";
import { guardUploads } from "./uploads/upload_start";
import "./design/index.css";

startTheme();
startPalette();
// Whatever an earlier visit couldn't send is sent from any page.
outbox.restore();
guardUploads();

const root = document.getElementById("root");
if (root === null) throw new Error("index.html has no #root");
createRoot(root).render(
  <StrictMode>
    <Application />
  </StrictMode>,
);
