// What a deflection r of 0 to 1 asks for: (1 - e) r + e r^3, fine near the centre and whole at the end.

export const USUAL_EXPO = 0.7;

// The factor by which a stick's two axes shrink at deflection r.
export const factor = (r, expo) => 1 - expo + expo * r * r;
