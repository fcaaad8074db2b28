import type { Submission } from "../../api/board_types";
import { Icon } from "../../design/icons";
import { Progress } from "../../design/progress";
import { type Step, stepsOf } from "./submission_steps";
import "./steps.css";

/** The road of a submission: what is behind it, where it is, what lies ahead. */
export function Steps({ submission }: { submission: Submission }) {
  return (
    <ol className="steps" aria-label="Steps">
      {stepsOf(submission).map((step) => (
        <StepItem key={step.name} step={step} />
      ))}
    </ol>
  );
}

const ICONS = { done: "check", failed: "warning", current: "play", ahead: "circle" } as const;

function StepItem({ step }: { step: Step }) {
  return (
    <li className={`step step--${step.state}`} aria-current={step.state === "current" ? "step" : undefined}>
      <span className="step__icon">
        {step.state === "current" ? (
          <span className="spinner" />
        ) : (
          <Icon name={ICONS[step.state]} size={14} />
        )}
      </span>
      <span className="step__text">
        <strong>{step.name}</strong>
        {step.text ? <span className="muted numeric">{step.text}</span> : null}
      </span>
      {step.progress === null ? null : <Progress label={step.name} value={step.progress} total={1} />}
    </li>
  );
}
