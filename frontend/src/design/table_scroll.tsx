import { type ReactNode, useCallback, useLayoutEffect, useRef, useState } from "react";
import "./table_scroll.css";

interface TableScrollProps {
  /** What is in it, for who can't see it. */
  label: string;
  className?: string;
  children: ReactNode;
}

interface Hidden {
  left: boolean;
  right: boolean;
}

/** A wide table that is scrolled sideways, by keyboard too; a fade tells on which side there is more. */
export function TableScroll({ label, className = "", children }: TableScrollProps) {
  const scroller = useRef<HTMLElement>(null);
  const [hidden, setHidden] = useState<Hidden>({ left: false, right: false });
  const look = useCallback(() => {
    const box = scroller.current;
    if (!box) return;
    const left = box.scrollLeft > 1;
    const right = box.scrollLeft + box.clientWidth < box.scrollWidth - 1;
    setHidden((old) => (old.left === left && old.right === right ? old : { left, right }));
  }, []);
  useLayoutEffect(() => {
    const box = scroller.current;
    if (!box) return;
    look();
    const sizes = new ResizeObserver(look);
    sizes.observe(box);
    if (box.firstElementChild) sizes.observe(box.firstElementChild);
    return () => sizes.disconnect();
  }, [look]);
  const scrolls = hidden.left || hidden.right;
  return (
    <div
      className={`table-scroll ${className}`.trim()}
      data-more-left={hidden.left || undefined}
      data-more-right={hidden.right || undefined}
    >
      <section
        ref={scroller}
        className="table-scroll__region"
        aria-label={scrolls ? label : undefined}
        tabIndex={scrolls ? 0 : undefined}
        onScroll={look}
      >
        {children}
      </section>
    </div>
  );
}
