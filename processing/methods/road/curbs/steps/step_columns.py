"""What is known of each step of a scanline: the columns of a table."""

(
    SECTION,
    LOWER_ACROSS,
    UPPER_ACROSS,
    LOWER_HEIGHT,
    UPPER_HEIGHT,
    SIGN,
    SIGNIFICANCE,
    TOP_M,
    FOOT_M,
    FACE_COUNT,
    FOOT_SLOPE,
    TOP_SLOPE,
    VERTEX,
    FOOT_ROUGH_M,
    FOOT_COVER_M,
) = range(15)
"""Columns of a step: scanline; edges across and their heights, m; 1 where the ground rises to the
right, −1 to the left; height in standard deviations; width of level ground seen behind and
before, m; vertices on the face; slopes of foot and top, rising towards the upper side; the vertex
nearest to the face; how far vertices before the lower edge lie off the foot, m, those of the ground
alone and with what hangs over it or lies deep below it."""
STEP_COLUMNS = 15
