// @TITLE@; lengths in @UNIT@; @SWAPPED@.
// povray +A +W1200 +H900 @NAME@
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { srgb <1, 1, 1> }
camera { location @LOCATION@ direction @DIRECTION@ * z up y right x * image_width / image_height sky y look_at @MIDDLE@ }
light_source { @LIGHT@ srgb <1, 1, 1> parallel point_at @MIDDLE@ }
light_source { @FILL_LIGHT@ srgb <0.25, 0.27, 0.30> parallel point_at @MIDDLE@ shadowless }
#declare Thickness = @THICKNESS@;
@SIZES@@OUTLINE@