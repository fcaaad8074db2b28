import "./dataset_card.css";

/** The place of the cards while they load. */
export function DatasetSkeletons() {
  return (
    <div role="status" aria-label="Loading datasets">
      <div className="datasets-page__header">
        <div>
          <h1>Datasets</h1>
          <p className="muted">&nbsp;</p>
        </div>
      </div>
      <div className="dataset-cards" aria-hidden="true">
        {[0, 1, 2].map((place) => (
          <div key={place} className="dataset-card card">
            <div className="dataset-cover skeleton" />
            <div className="dataset-card__body">
              <div className="skeleton" style={{ width: "60%", height: 20 }} />
              <div className="skeleton" style={{ width: "40%", height: 14 }} />
              <div className="skeleton" style={{ height: 24 }} />
            </div>
          </div>
        ))}
      </div>
    </div>
  );
}
