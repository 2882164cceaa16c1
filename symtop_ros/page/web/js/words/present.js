// Why the axle speeds up, slows down or turns at the instant that is shown.

import { nameSubject } from "./verdict.js";
import { phrase } from "./wording.js";

/** @import { Course } from "../physics/course.js" */
/** @import { State } from "../physics/state.js" */

/**
 * The sentence of an instant; none if the kernel has none, and where more than gravity acts.
 * @param {Course} course @param {State} state
 */
export const describePresent = (course, state) => {
  if (course.isDriven || course.clamped || course.pushes) return "";
  const free = course.continueFree(state);
  const { going, turn: needs, torque_share: share } = course.kernel.explainPresent(free.packed);
  if (!going) return "";
  const pace = { falls: share < 1 ? "faster" : "slower", rises: share > 1 ? "faster" : "slower" };
  const effect =
    going in pace ? `${going}_${pace[/** @type {"falls" | "rises"} */ (going)]}` : going;
  return phrase("present", { needs, effect, subject: nameSubject(course.top) });
};
