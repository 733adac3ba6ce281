// What all passes of a picture share; FrameBlock in passes.h is its image.
layout(std140) uniform Frame {
  mat4 clip_from_world;        // infinite, reversed: 1 at the near plane, 0 far away
  mat4 shadow_from_world[2];   // light.h
  mat4 view_from_world;
  vec4 eye;                    // p_WCam; w: tan of half the vertical field of view
  vec4 to_light;               // unit; w: tan of the light's angular radius
  vec4 map_x;                  // the shadow map's axes in the world
  vec4 map_y;
  vec4 shadow_width;           // [m] of layers 0 and 1; then their depths
  vec4 picture;                // width, height; x and y of this tile's lower left [pixels]
  vec4 target;                 // p_WTarget; w: height of the view there [m]
  vec4 ground;                 // z; spacing of the grid [m]; 1 if there is one; radius it fades at [m]
  vec4 tuning;                 // near plane [m]; radius of occlusion [m]; picture scale (1 at 720 high); texels across a shadow map
};
