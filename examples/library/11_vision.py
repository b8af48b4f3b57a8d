"""A red post is found in three pictures, and where it stands follows from where they were taken."""

import numpy as np

from uvf.vision import ColourRange, MarkerMap, MarkerModel, Sighting, colour_blobs

FOCAL, MIDDLE = 200.0, (79.5, 59.5)  # pixels
POST = np.array((6.0, 2.0, 0.5))  # m: the middle of a post of 1 m
red = ColourRange(hue=0.0, width=0.3, least_saturation=0.4, least_value=0.2)
posts = MarkerMap(MarkerModel(1.0, ground=0.0, ground_sigma=0.3, pose_sigma=0.1, angle_sigma=0.01, reach=50.0, least_apart=1.0))

for y in (0.5, 1.5, 2.5):
    eye = np.array((0.0, y, 0.4))  # a camera that looks to the east: its x is south, its y down
    away = POST - eye
    column, row = MIDDLE[0] - FOCAL * away[1] / away[0], MIDDLE[1] - FOCAL * away[2] / away[0]
    picture = np.full((120, 160, 3), (90, 110, 80), dtype=np.uint8)
    picture[round(row) - 17 : round(row) + 17, round(column) - 4 : round(column) + 4] = (220, 20, 10)

    for blob in colour_blobs(picture, red, least=10):
        ray = np.array((1.0, -(blob.column - MIDDLE[0]) / FOCAL, -(blob.row - MIDDLE[1]) / FOCAL))
        posts.see(Sighting(eye, ray / np.linalg.norm(ray), height=float(np.arctan(blob.height / FOCAL))))

(post,) = posts.markers
print(f"a post at ({post.position[0]:.1f}, {post.position[1]:.1f}) m, seen from {post.views} places, 1 sigma {post.sigma:.1f} m")
