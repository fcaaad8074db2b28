import { useRights } from "../../api/use_rights";
import { Icon } from "../../design/icons";
import { EmptyState } from "../../design/states";
import { FileButtons } from "../../uploads/file_buttons";
import type { Picked } from "../../uploads/picked_files";

export function EmptyDataset({ onPicked }: { onPicked: (picked: Picked) => void }) {
  const { maintain } = useRights();
  if (!maintain) {
    return (
      <EmptyState icon="images" title="No images yet">
        Whoever maintains this dataset hasn't added any.
      </EmptyState>
    );
  }
  return (
    <section className="empty-dataset">
      <Icon className="empty-dataset__icon" name="images" size={36} />
      <h2>Add images</h2>
      <p className="muted">
        Drop files, folders or zips here. A zip in the ClearLines layout brings its labels, cameras and
        sources too.
      </p>
      <div className="empty-dataset__actions">
        <FileButtons tone="primary" onPicked={onPicked} />
      </div>
    </section>
  );
}
