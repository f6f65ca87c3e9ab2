"""What is known of each step of a scanline: the columns of a table."""

(
    SECTION,
    LOWER_ACROSS,
    UPPER_ACROSS,
    LOWER_HEIGHT,
    UPPER_HEIGHT,
    SIGN,
    SURENESS,
    TOP_M,
    FOOT_M,
    FACE_COUNT,
    FOOT_SLOPE,
    TOP_SLOPE,
    TOP_ROUGH_M,
    NOISE_M,
    VERTEX,
    FOOT_ROUGH_M,
) = range(16)
"""Columns of a step: scanline; edges across and their heights, m; 1 where the ground rises to the
right, −1 to the left; height in standard deviations; width of level ground seen behind and
before, m; vertices on the face; slopes of foot and top, rising towards the upper side; how far
all vertices behind the upper edge lie off the top, and what is usual on that scanline, m; the
vertex nearest to the face; how far vertices before the lower edge lie off the foot, m."""
STEP_COLUMNS = 16
